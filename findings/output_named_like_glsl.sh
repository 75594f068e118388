#!/usr/bin/env bash
# MaterialX: an output named like some words of GLSL makes a shader that is no GLSL; like others, not.
#
# Guess:    a name that means something in GLSL is renamed in the generated text wherever it stands, since the generator has a list of
#           reserved words and a document's author need not know the language.
# Happens:  names of nodes are always safe (`max` becomes max_out). A graph's output called float, sampler2D, discard, switch or in is
#           renamed. One called const, uniform, attribute, varying, layout, shared or precise is written as it is and nothing compiles. So
#           is one called main, or called like a function that the graph needs: a graph that takes a maximum cannot call its result `max`.
# Versions: MaterialX 1.39.5 (PyPI), glslang 12.0.0 (Debian 12).
# Matters:  who names outputs after what they hold (max, pow, shared, uniform, layout), writes exporters, or relies on validate(), which
#           accepts every one of them.
set -euo pipefail

missing() {
    echo "skipped: $1"
    exit 77
}
command -v glslangValidator >/dev/null || missing "glslangValidator is needed (Debian: glslang-tools)"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv 2>venv.txt || missing "python3 with venv is needed"
venv/bin/pip install -q materialx==1.39.5 2>pip.txt || missing "materialx 1.39.5 could not be installed: $(tail -n 1 pip.txt)"
cat >probe.py <<'PYTHON'
import pathlib
import subprocess
import sys

import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as mx_glsl
import MaterialX.PyMaterialXGenShader as mx_gen

REFUSED = ["const", "uniform", "attribute", "varying", "layout", "shared", "precise", "main", "max", "pow"]
ACCEPTED = ["float", "sampler2D", "discard", "switch", "in", "min", "brightest"]

library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
generator = mx_glsl.GlslShaderGenerator.create()
context = mx_gen.GenContext(generator)
context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())


def error_of(node, output):
    """The compiler's first complaint about max(u, 0.2) to the power of 2.2, with nodes and output so named; empty where there is none."""
    document = mx.createDocument()
    mx.readFromXmlString(document, f"""<materialx version="1.39"><nodegraph name="pattern">
        <texcoord name="uv" type="vector2"/>
        <extract name="u" type="float"><input name="in" type="vector2" nodename="uv"/></extract>
        <max name="{node}" type="float"><input name="in1" type="float" nodename="u"/><input name="in2" type="float" value="0.2"/></max>
        <power name="last" type="float"><input name="in1" type="float" nodename="{node}"/><input name="in2" type="float" value="2.2"/></power>
        <output name="{output}" type="float" nodename="last"/></nodegraph></materialx>""")
    document.setDataLibrary(library)
    assert document.validate()[0], document.validate()[1]
    shader = generator.generate("probe", document.getDescendant("pattern/" + output), context)
    pathlib.Path("probe.frag").write_text(shader.getSourceCode("pixel"))
    run = subprocess.run(["glslangValidator", "probe.frag"], capture_output=True, text=True)
    return next(line for line in run.stdout.splitlines() if "ERROR" in line) if run.returncode else ""


print("MaterialX", mx.getVersionString())
print(subprocess.run(["glslangValidator", "--version"], capture_output=True, text=True).stdout.splitlines()[0])
changed = False
for name in REFUSED + ACCEPTED:
    as_node, as_output = error_of(name, "result"), error_of("brighter", name)
    print(f"{name}: as a node {as_node or 'compiles'}; as an output {as_output or 'compiles'}")
    changed |= bool(as_node) or bool(as_output) != (name in REFUSED)
print("changed" if changed else "as written")
sys.exit(changed)
PYTHON
venv/bin/python probe.py
