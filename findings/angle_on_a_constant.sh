#!/usr/bin/env bash
# MaterialX: an angle with a unit, on a node that has no unit of its own, stops the generator.
#
# Guess:    `<constant>` with unittype="angle" and unit="radian" (or "degree") that feeds the amount of a rotate2d turns as far as the same
#           value written on rotate2d itself.
# Happens:  where the host has said that its scene is in metres, the generator throws "Unrecognized destination unit: meter": the angle
#           is to be converted to the scene's unit of length. The same document with the value on rotate2d works, a distance
#           on a constant works. Where the host says no unit of length, the constant's text is used as it is: 1.57 radians turn by 1.57 degrees.
# Versions: MaterialX 1.39.5 (PyPI).
# Matters:  who writes or exports documents with units (values pulled out into constants to be shared), and hosts, which set a unit of
#           length as a matter of course and learn of the document's angle by an exception that names metres.
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

QUARTER = {"radian": "1.5707963", "degree": "90"}
library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)


def generator_for(length):
    generator = mx_glsl.GlslShaderGenerator.create()
    context = mx_gen.GenContext(generator)
    context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
    registry = mx.UnitConverterRegistry.create()
    for kind in ("distance", "angle"):
        definition = library.getUnitTypeDef(kind)
        registry.addUnitConverter(definition, mx.LinearUnitConverter.create(definition))
    system = mx_gen.UnitSystem.create(generator.getTarget())
    system.loadLibrary(library)
    system.setUnitConverterRegistry(registry)
    generator.setUnitSystem(system)
    context.getOptions().targetDistanceUnit = length
    context.getOptions().shaderInterfaceType = mx_gen.ShaderInterfaceType.SHADER_INTERFACE_REDUCED
    return generator, context


def attempt(length, text):
    """What becomes of the number: its factor in the text, or the exception."""
    document = mx.createDocument()
    mx.readFromXmlString(document, f'<materialx version="1.39">{text}</materialx>')
    document.setDataLibrary(library)
    assert document.validate()[0], document.validate()[1]
    generator, context = generator_for(length)
    try:
        shader = generator.generate("probe", document.getDescendant("result"), context).getSourceCode("pixel")
    except Exception as error:
        return f"exception: {error}"
    factor = re.search(r"unit_in2\w* = ([0-9.]+)", shader)
    return f"converted, times {float(factor[1]):g}" if factor else "not converted"


def rotated(unit, apart):
    written = f'type="float" value="{QUARTER[unit]}" unittype="angle" unit="{unit}"'
    constant = f'<constant name="quarter" type="float"><input name="value" {written}/></constant>' if apart else ""
    amount = '<input name="amount" type="float" nodename="quarter"/>' if apart else f'<input name="amount" {written}/>'
    return (f'{constant}<rotate2d name="turn" type="vector2"><input name="in" type="vector2" value="1, 0"/>{amount}</rotate2d>'
            '<output name="result" type="vector2" nodename="turn"/>')


LENGTH = ('<constant name="length" type="float"><input name="value" type="float" value="25" unittype="distance" unit="centimeter"/></constant>'
          '<output name="result" type="float" nodename="length"/>')
THROWS = "exception: Unrecognized destination unit: meter"
rows = [  # scene's unit, what, document, expected
    ("meter", "25 centimetres by a constant", LENGTH, "converted, times 0.01"),
    ("meter", "radians on rotate2d", rotated("radian", False), "converted, times 57.2958"),
    ("meter", "radians by a constant", rotated("radian", True), THROWS),
    ("meter", "degrees by a constant", rotated("degree", True), THROWS),
    ("", "radians by a constant", rotated("radian", True), "not converted"),
]
print("MaterialX", mx.getVersionString())
changed = False
for length, what, text, expected in rows:
    seen = attempt(length, text)
    changed |= seen != expected
    print(f"scene in {length or 'no unit'}: {what}: {seen}" + ("" if seen == expected else f" (was: {expected})"))
print("changed" if changed else "as written")
sys.exit(changed)
PYTHON
venv/bin/python probe.py
