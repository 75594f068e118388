"""tools/testsuite: MaterialX's TestSuite, where a checkout has ../shared: every renderable element generates, and is drawn as
its reference at the reference's own 16 samples.

  tools/testsuite --all         tries all and writes docs/testsuite.md
  tools/testsuite               a fixed slice, against what docs/testsuite.md says
  tools/testsuite --only REGEX  tries those documents, prints every element, writes nothing
"""
import argparse
import fnmatch
import gzip
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from run import ROOT, Compiler, Pairs, file_name, under_judge, write_pictures

HERE = pathlib.Path(__file__).resolve().parent
PAGE = ROOT / "docs/testsuite.md"
LIMIT = 0.02
SKIPPED = 77  # the exit code of a check that tried nothing
SLICE = 6  # every how many documents one is tried in a plain run


class Element:
    def __init__(self, document, path):
        self.document, self.path = document, path
        self.name = f"{document.name}.{re.sub(r'[^A-Za-z0-9_]', '_', path)}"
        self.refused = self.rmse = self.drawn = None
        self.glslang = ""


class Known:
    """Lines of a file: `document.mtlx.element | reason`, with wildcards."""

    def __init__(self, file):
        lines = (HERE / file).read_text().splitlines()
        self.rows = [[p.strip() for p in l.split("|", 1)] for l in lines if l.strip() and not l.startswith("#")]
        self.used = set()

    def reason(self, name):
        for i, (pattern, reason) in enumerate(self.rows):
            if fnmatch.fnmatchcase(name, pattern):
                self.used.add(i)
                return reason
        return None

    def unused(self):
        return [" | ".join(row) for i, row in enumerate(self.rows) if i not in self.used]


class Run:
    def __init__(self, arguments, documents, peer):
        self.arguments, self.documents, self.peer = arguments, documents, peer
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shaderx_testsuite_"))
        self.compiler, self.pairs = Compiler(arguments.exe), Pairs(arguments.pair)
        self.elements = []

    def shader(self, element):
        return self.folder / element.document.stem / file_name(element.document.stem, element.path)

    def generate(self):
        """All elements that the peer calls renderable: of the document as a whole, or by their path."""
        for document in self.documents:
            out = self.folder / document.stem
            errors, codes = self.compiler.generate([document], out)
            first = next(iter(errors.values()), None) or f"exit code {max(codes)}, no shader"
            for path in self.peer.renderable(self.peer.read_file(document)):
                element = Element(document, path)
                self.elements.append(element)
                if self.shader(element).with_name(self.shader(element).name + ".frag").exists():
                    continue
                one, codes = self.compiler.generate([document], out, "--element", path)
                if max(codes) not in (0, 1):
                    element.refused = f"exit code {max(codes)}: {one.get('?', '')}"
                elif not self.shader(element).with_name(self.shader(element).name + ".frag").exists():
                    element.refused = next(iter(one.values()), None) or first

    def draw(self):
        write_pictures(self.folder)
        jobs = []
        for element in self.elements:
            if element.refused:
                continue
            stem = str(self.shader(element))
            job = {"id": element.name, "pictures": str(self.folder / "grid.pfm"), "size": 64, "samples": 16,
                   "ours": [[stem + ".vert", stem + ".frag"]]}
            reference = self.arguments.shared / "reference/testsuite" / (element.name + ".pfm.gz")
            if reference.exists():
                job["theirs"] = str(self.folder / (element.name + ".pfm"))
                pathlib.Path(job["theirs"]).write_bytes(gzip.decompress(reference.read_bytes()))
            jobs.append(job)
        answers = self.pairs.run(jobs)
        for element in self.elements:
            if not element.refused:
                self.take(element, answers[element.name])

    def take(self, element, answer):
        if "died" in answer:
            element.drawn = f"the driver died ({answer['died']})"
            return
        row = answer["ours"][0]
        element.glslang, element.drawn, element.rmse = row["glslang"], row["draw"], row.get("rmse")

    def run(self):
        self.generate()
        self.draw()
        if not self.arguments.keep:
            shutil.rmtree(self.folder)


def problems(run, refusals, differences):
    """What neither file of reasons tells."""
    found = []
    for e in run.elements:
        if e.refused:
            if refusals.reason(e.name) is None:
                found.append(f"{e.name} ({e.path}): refused: {e.refused}")
        elif e.glslang or e.drawn:
            found.append(f"{e.name}: {e.glslang or e.drawn}")
        elif e.rmse is not None and not e.rmse <= LIMIT and differences.reason(e.name) is None:
            found.append(f"{e.name} ({e.path}): RMSE {e.rmse:.3f}")
    return found


def write_page(run, refusals, differences):
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    refused = [e for e in run.elements if e.refused]
    compared = [e for e in run.elements if e.rmse is not None]
    above = sorted((e for e in compared if not e.rmse <= LIMIT), key=lambda e: -e.rmse)
    page = [f"""# MaterialX's TestSuite

Written by `tools/testsuite --all`. Commit {commit}, {run.compiler.version()}, MaterialX {run.peer.version}; references of 64 × 64 pixels at 16 samples, drawn by
MaterialX. Root of the mean squared difference (RMSE) over the picture, linear, values from 0 to 4.

{len(run.elements)} elements that MaterialX calls renderable, in {len(run.documents)} documents: {len(run.elements) - len(refused)} generate, pass glslang and draw; {len(refused)} are
refused. {len(compared)} have a reference: {len(compared) - len(above)} are within {LIMIT}, {len(above)} are not.

## Refused

| element | message | why |
|---|---|---|"""]
    cell = lambda s: s.replace("|", "/")
    page += [f"| {e.document.name} {e.path} | {cell(e.refused)} | {cell(refusals.reason(e.name) or 'not explained')} |" for e in refused]
    page.append(f"\n## Above {LIMIT}\n\n| element | RMSE | why |\n|---|---|---|")
    page += [f"| {e.document.name} {e.path} | {e.rmse:.3f} | {cell(differences.reason(e.name) or 'not explained')} |" for e in above]
    PAGE.write_text("\n".join(page) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--only")
    parser.add_argument("--keep", action="store_true", help="leave the shaders in the temporary folder, and say where")
    parser.add_argument("--exe", default=ROOT / "build/release/shaderx", type=pathlib.Path)
    parser.add_argument("--pair", default=ROOT / "build/release/tests/peer/shader_pair", type=pathlib.Path)
    parser.add_argument("--shared", default=ROOT.parent / "shared", type=pathlib.Path)
    arguments = parser.parse_args()
    suite = arguments.shared / "resources/Materials/TestSuite"
    if not PAGE.exists() and not arguments.all and not arguments.only:
        print("docs/testsuite.md is not there: tools/testsuite --all writes it")
        return 1
    if not suite.is_dir():
        print("skipped: MaterialX's TestSuite, for there is no ../shared/resources")
        return SKIPPED
    missing = under_judge("materialx")
    if missing:
        print(f"skipped: MaterialX's TestSuite: {missing}")
        return 3 if arguments.all else SKIPPED
    from materialx import Peer
    documents = sorted(suite.rglob("*.mtlx"))
    if arguments.only:
        documents = [d for d in documents if re.search(arguments.only, d.name)]
    elif not arguments.all:
        documents = documents[::SLICE]
    run = Run(arguments, documents, Peer())
    run.run()
    refusals, differences = Known("testsuite_refused.txt"), Known("testsuite_differs.txt")
    bad = problems(run, refusals, differences)
    if arguments.only:
        for e in run.elements:
            print(e.name, "refused: " + e.refused if e.refused else e.glslang or e.drawn or ("no reference" if e.rmse is None else f"{e.rmse:.4f}"))
    if arguments.all:
        write_page(run, refusals, differences)
        bad += [f"told, but not so: {line}" for line in refusals.unused() + differences.unused()]
    if arguments.keep:
        print(run.folder)
    print(*bad, sep="\n")
    compared = [e.rmse for e in run.elements if e.rmse is not None]
    print(f"{len(run.elements)} elements of {len(documents)} documents, {sum(e.refused is None for e in run.elements)} generated, "
          f"{len(compared)} compared, {sum(r <= LIMIT for r in compared)} within {LIMIT}; {len(bad)} problems")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
