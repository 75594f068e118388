#!/usr/bin/env bash
# MaterialX's upgrade of a 1.38 document puts a thin film on a lobe that had none.
#
# Guess:    where one dielectric_bsdf is used twice in 1.38, once below a thin_film_bsdf and once bare, the upgrade to 1.39 makes two
#           of it: one with the film's thickness and index as inputs, one without.
# Happens:  the film's values are written onto the one node that is there, and both uses show the film. A mix of filmed and bare
#           coat, which masks the film by a weight, becomes a mix of twice the same node: the mask has lost its effect.
#           Nothing is said; the outcome validates. MaterialX 1.38 itself finds the document valid and keeps both uses apart.
# Versions: MaterialX 1.39.5 and 1.38.10 (PyPI).
# Matters:  who has materials of 1.38 with masked films (soap, oil, oxide, coated glass) and lets the library upgrade them on reading:
#           they come out iridescent all over.
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
venv/bin/pip install -q --target old materialx==1.38.10 2>pip.txt || missing "materialx 1.38.10 could not be installed: $(tail -n 1 pip.txt)"
cat >masked_film.mtlx <<'DOCUMENT'
<?xml version="1.0"?>
<materialx version="1.38">
  <dielectric_bsdf name="clear" type="BSDF">
    <input name="ior" type="float" value="1.5"/>
  </dielectric_bsdf>
  <thin_film_bsdf name="oil" type="BSDF">
    <input name="thickness" type="float" value="430"/>
    <input name="ior" type="float" value="1.35"/>
  </thin_film_bsdf>
  <layer name="oily" type="BSDF">
    <input name="top" type="BSDF" nodename="oil"/>
    <input name="base" type="BSDF" nodename="clear"/>
  </layer>
  <mix name="masked" type="BSDF">
    <input name="fg" type="BSDF" nodename="oily"/>
    <input name="bg" type="BSDF" nodename="clear"/>
    <input name="mix" type="float" value="0.25"/>
  </mix>
  <surface name="shaded" type="surfaceshader">
    <input name="bsdf" type="BSDF" nodename="masked"/>
  </surface>
</materialx>
DOCUMENT
cat >probe.py <<'PYTHON'
import sys

import MaterialX as mx

print("MaterialX", mx.getVersionString())
document = mx.createDocument()
mx.readFromXmlFile(document, "masked_film.mtlx")
if mx.getVersionString().startswith("1.38"):
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document.importLibrary(library)
valid = document.validate()[0]
print("valid:", valid)


def of(port):
    """The node that the mask mixes there, and whether a film lies on it."""
    node = document.getNode("masked").getConnectedNode(port)
    filmed = node.getCategory() == "layer" or float(node.getInputValue("thinfilm_thickness") or 0) > 0
    return node.getName(), filmed


filmed, bare = of("fg"), of("bg")
for port, (name, film) in (("fg", filmed), ("bg", bare)):
    print(f"masked.{port} reads '{name}',", "with a film" if film else "without a film")
lost = filmed[1] and bare[1] and filmed[0] == bare[0]
sys.exit(0 if valid and lost == (sys.argv[1] == "lost") else 1)
PYTHON
result=0
PYTHONPATH=old venv/bin/python probe.py kept || result=1
venv/bin/python probe.py lost || result=1
if ((result)); then echo "changed"; else echo "as written"; fi
exit $result
