#!/usr/bin/env bash
# MaterialX: whether glass may be seen through depends on the model that it is written in.
#
# Guess:    isTransparentSurface(), which says whether a surface has the potential of being transparent, says the same of one and the same clear
#           glass in each of the standard surface models.
# Happens:  it is true for standard_surface, gltf_pbr, open_pbr_surface and for a model of one's own that is a graph around one of these, whatever
#           its ports are called. It is false for disney_principled with specTrans 1, for LamaSurface of LamaDielectric, and
#           for a `surface` whose only lobe is a dielectric_bsdf that transmits. gltf_pbr with alpha 0.5 is transparent even where its
#           alpha_mode says that alpha is ignored.
# Versions: MaterialX 1.39.5 (PyPI).
# Matters:  hosts that sort, blend or cull by it, and set the generator's hwTransparency from it: a glass of the one model is drawn among the
#           opaque things, the same glass translated to another model is not.
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
import sys

import MaterialX as mx
import MaterialX.PyMaterialXGenShader as mx_gen

library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)


def model(category, *values):
    inputs = "".join(f'<input name="{name}" type="{kind}" value="{value}"/>' for name, kind, value in values)
    return f'<{category} name="glass" type="surfaceshader">{inputs}</{category}>'


OWN = """<nodedef name="ND_own_glass" node="own_glass"><input name="clarity" type="float" value="0"/>
    <output name="out" type="surfaceshader"/></nodedef>
    <nodegraph name="NG_own_glass" nodedef="ND_own_glass"><standard_surface name="inner" type="surfaceshader">
    <input name="transmission" type="float" interfacename="clarity"/></standard_surface>
    <output name="out" type="surfaceshader" nodename="inner"/></nodegraph>"""
LOBE = """<dielectric_bsdf name="lobe" type="BSDF"><input name="scatter_mode" type="string" value="RT"/></dielectric_bsdf>
    <surface name="glass" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="lobe"/></surface>"""
LAMA = """<LamaDielectric name="lobe" type="BSDF"/>
    <LamaSurface name="glass" type="material"><input name="materialFront" type="BSDF" nodename="lobe"/></LamaSurface>"""
rows = [  # what, document, expected
    ("standard_surface without transmission", model("standard_surface"), False),
    ("standard_surface", model("standard_surface", ("transmission", "float", 1)), True),
    ("gltf_pbr", model("gltf_pbr", ("transmission", "float", 1)), True),
    ("open_pbr_surface", model("open_pbr_surface", ("transmission_weight", "float", 1)), True),
    ("own graph around standard_surface", OWN + model("own_glass", ("clarity", "float", 1)), True),
    ("disney_principled", model("disney_principled", ("specTrans", "float", 1)), False),
    ("LamaSurface", LAMA, False),
    ("surface of dielectric_bsdf", LOBE, False),
    ("gltf_pbr, no glass: alpha 0.5, opaque", model("gltf_pbr", ("alpha", "float", 0.5), ("alpha_mode", "integer", 0)), True),
]
print("MaterialX", mx.getVersionString())
changed = False
for what, text, expected in rows:
    document = mx.createDocument()
    mx.readFromXmlString(document, f'<materialx version="1.39">{text}</materialx>')
    document.setDataLibrary(library)
    assert document.validate()[0], document.validate()[1]
    seen = mx_gen.isTransparentSurface(document.getDescendant("glass"), "genglsl")
    print(f"{what}: {'transparent' if seen else 'opaque'}")
    changed |= seen != expected
print("changed" if changed else "as written")
sys.exit(changed)
PYTHON
venv/bin/python probe.py
