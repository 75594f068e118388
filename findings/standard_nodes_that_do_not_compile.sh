#!/usr/bin/env bash
# Standard nodes of MaterialX whose generated GLSL is no GLSL.
#
# Guess:    every node of the standard libraries for which the GLSL generator writes a shader without complaint, from a document that
#           validate() accepts, gets a shader that compiles.
# Happens:  with values written into the text (the "reduced" interface), of about 700 shaders these do not compile: hextilednormalmap, whose
#           file stands in the call as its name, where a sampler is meant (hextiledimage is right); and three helpers of hair
#           shading, chiang_hair_roughness, chiang_hair_absorption_from_color and deon_hair_absorption_from_melanin, when they are looked at
#           by themselves: their shader holds code for an environment that is not there. Of surfaces: `convert` of a colour to a
#           surface, `dot` and `mix` of surface_unlit, whose text reads a number of lights that nobody declares. A mere `dot`, which
#           changes nothing, breaks a surface that compiles without it; over a standard_surface it does not.
# Versions: MaterialX 1.39.5 (PyPI), glslang 12.0.0 (Debian 12).
# Matters:  who takes a document that validates and a generator that returns for a shader that runs. A library of nodes has to be compiled
#           node by node, each surface node also over a surface without lighting.
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
import concurrent.futures
import pathlib
import subprocess
import sys

import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as mx_glsl
import MaterialX.PyMaterialXGenShader as mx_gen

EXPECTED = {
    "ND_hextilednormalmap_vector3", "ND_chiang_hair_roughness", "ND_chiang_hair_absorption_from_color", "ND_deon_hair_absorption_from_melanin",
    "convert to a surface", "dot of surface_unlit", "mix of surface_unlit",
}
SURFACES = {  # what is read by the material, called s
    "surface_unlit": '<surface_unlit name="s" type="surfaceshader"/>',
    "convert to a surface": '<convert name="s" type="surfaceshader"><input name="in" type="color3" value="0.8, 0.4, 0.2"/></convert>',
}
for category in ("surface_unlit", "standard_surface"):
    two = "".join(f'<{category} name="{name}" type="surfaceshader"/>' for name in "ab")
    SURFACES["dot of " + category] = two + '<dot name="s" type="surfaceshader"><input name="in" type="surfaceshader" nodename="a"/></dot>'
    SURFACES["mix of " + category] = two + (
        '<mix name="s" type="surfaceshader"><input name="bg" type="surfaceshader" nodename="a"/>'
        '<input name="fg" type="surfaceshader" nodename="b"/><input name="mix" type="float" value="0.5"/></mix>')
VALUES = ("float", "integer", "boolean", "color3", "color4", "vector2", "vector3", "vector4", "BSDF", "EDF")

library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
generator = mx_glsl.GlslShaderGenerator.create()
context = mx_gen.GenContext(generator)
context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
context.getOptions().shaderInterfaceType = mx_gen.ShaderInterfaceType.SHADER_INTERFACE_REDUCED


def generate(document, path):
    """The text of the pixel shader, or None where the generator says that it has none."""
    valid, why = document.validate()
    assert valid, why
    try:
        return generator.generate("probe", document.getDescendant(path), context).getSourceCode("pixel")
    except Exception:
        return None


def of_node(definition):
    document = mx.createDocument()
    document.setDataLibrary(library)
    document.addNodeInstance(definition, "node")
    first = definition.getActiveOutputs()[0]
    output = document.addOutput("result", first.getType())
    output.setNodeName("node")
    if len(definition.getActiveOutputs()) > 1:
        output.setOutputString(first.getName())
    return generate(document, "result")


def of_surface(text):
    document = mx.createDocument()
    mx.readFromXmlString(document, '<materialx version="1.39">' + text + '<surfacematerial name="m" type="material">'
                         '<input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial></materialx>')
    document.setDataLibrary(library)
    return generate(document, "m")


def compiles(name, text):
    file = pathlib.Path(name.replace(" ", "_") + ".frag")
    file.write_text(text)
    run = subprocess.run(["glslangValidator", str(file)], capture_output=True, text=True)
    return name, next((line for line in run.stdout.splitlines() if "ERROR" in line), "") if run.returncode else ""


shaders = {name: of_surface(text) for name, text in SURFACES.items()}
for definition in library.getNodeDefs():
    if definition.getActiveOutputs()[0].getType() in VALUES:
        shaders[definition.getName()] = of_node(definition)
shaders = {name: text for name, text in shaders.items() if text}
with concurrent.futures.ThreadPoolExecutor() as pool:
    errors = {name: error for name, error in pool.map(lambda item: compiles(*item), shaders.items()) if error}

print("MaterialX", mx.getVersionString())
print(subprocess.run(["glslangValidator", "--version"], capture_output=True, text=True).stdout.splitlines()[0])
print(len(shaders), "shaders written,", len(errors), "of them refused:")
for name, error in sorted(errors.items()):
    print(f"  {name}: {error}")
print("Accepted, for contrast:", ", ".join(sorted(name for name in SURFACES if name not in errors)))
same = set(errors) == EXPECTED
print("as written" if same else f"changed: {sorted(set(errors) ^ EXPECTED)}")
sys.exit(0 if same else 1)
PYTHON
venv/bin/python probe.py
