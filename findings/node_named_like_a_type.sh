#!/usr/bin/env bash
# MaterialX: a node called `angle` is not found by the nodes that read it, and they compute with 0.
#
# Guess:    a node may have any name that is no other node's in its scope.
# Happens:  with the standard library attached by setDataLibrary(), the way that 1.39 offers, what the library has of that name at its
#           outer level, of whatever kind, is found in place of the document's node. There are its types (float, color3,
#           surfaceshader, material ...) and the kinds of units, angle and distance. A sum of a node called `angle` and 0.5 is generated
#           as 0 + 0.5, without an exception or a word. validate() reports an invalid connection, but only with the library attached.
#           With importLibrary() the sum is right, but the library loses its unit type and does not validate. In a nodegraph the same
#           names are harmless.
# Versions: MaterialX 1.39.5 (PyPI).
# Matters:  who names a constant after what it holds (angle, distance) at the outer level of a document, or a shader `surfaceshader`: the
#           material is generated with another value, and nothing says so.
set -euo pipefail

missing() {
    echo "skipped: $1"
    exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv 2>venv.txt || missing "python3 with venv is needed"
venv/bin/pip install -q materialx==1.39.5 2>pip.txt || missing "materialx 1.39.5 could not be installed: $(tail -n 1 pip.txt)"
cat >probe.py <<'PYTHON'
import re
import sys

import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as mx_glsl
import MaterialX.PyMaterialXGenShader as mx_gen

library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
generator = mx_glsl.GlslShaderGenerator.create()
context = mx_gen.GenContext(generator)
context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
context.getOptions().shaderInterfaceType = mx_gen.ShaderInterfaceType.SHADER_INTERFACE_REDUCED


def summed(name, in_graph, attach):
    """What the shader adds to 0.5, which is 0.25 by a constant of this name; whether the document is valid with the library, and without."""
    document = mx.createDocument()
    nodes = f"""<constant name="{name}" type="float"><input name="value" type="float" value="0.25"/></constant>
        <add name="sum" type="float"><input name="in1" type="float" nodename="{name}"/><input name="in2" type="float" value="0.5"/></add>
        <output name="result" type="float" nodename="sum"/>"""
    if in_graph:
        nodes = f'<nodegraph name="graph">{nodes}</nodegraph>'
    mx.readFromXmlString(document, f'<materialx version="1.39">{nodes}</materialx>')
    alone = document.validate()[0]
    attach(document)
    shader = generator.generate("probe", document.getDescendant("graph/result" if in_graph else "result"), context).getSourceCode("pixel")
    return float(re.search(r"sum_in1_tmp = ([0-9.]+);", shader)[1]), alone, document.validate()[0]


def attached(document):
    document.setDataLibrary(library)


def imported(document):
    document.importLibrary(library)


print("MaterialX", mx.getVersionString())
rows = [  # name, in a graph, library, expected: value, valid alone, valid with the library
    ("slope", False, attached, (0.25, True, True)),
    ("angle", False, attached, (0.0, True, False)),
    ("distance", False, attached, (0.0, True, False)),
    ("float", False, attached, (0.0, True, False)),
    ("surfaceshader", False, attached, (0.0, True, False)),
    ("angle", True, attached, (0.25, True, True)),
    ("angle", False, imported, (0.25, True, False)),
]
changed = False
for name, in_graph, attach, expected in rows:
    seen = summed(name, in_graph, attach)
    changed |= seen != expected
    place = "in a graph" if in_graph else "at the outer level"
    print(f"'{name}' {place}, library {attach.__name__}: 0.25 is read as {seen[0]:g}; valid alone: {seen[1]}, with the library: {seen[2]}")
print("changed" if changed else "as written")
sys.exit(changed)
PYTHON
venv/bin/python probe.py
