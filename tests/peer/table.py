"""tools/signatures: every node signature of the standard, tried in three interfaces and compared with a peer.

  tools/signatures --all            tries all and writes docs/signatures.md and docs/signatures.csv
  tools/signatures                  checks that the table is complete and holds no failure, and tries a fixed slice anew
  tools/signatures --only REGEX     tries those, prints every case, writes nothing
  tools/signatures --documents DIR  writes the documents of all cases, for other tools
"""
import argparse
import csv
import fnmatch
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from run import INTERFACES, ROOT, Compiler, Pairs, file_name, under_judge, write_pictures
from signatures import Maker, cases, library

HERE = pathlib.Path(__file__).resolve().parent
TABLE = ROOT / "docs/signatures.csv"
PAGE = ROOT / "docs/signatures.md"
VALUE_LIMIT, PICTURE_LIMIT, FURNACE_LIMIT, EDGE_LIMIT = 1e-3, 0.005, 1.001, 0.005
SLICE = 20  # every how many signatures one is tried in a plain run
GOOD = ("same", "edges", "formula", "explained", "open")
COLUMNS = ("signature", "family", "cases", "elements", "compared", "max", "odd", "rmse", "furnace", "verdict", "case", "reason")


def lines(name):
    return [l for l in (HERE / name).read_text().splitlines() if l.strip() and not l.startswith("#")]


class Explained:
    """What is known to differ, and why: lines of explained.txt, `signature | case | verdict | reason`, with wildcards."""

    def __init__(self):
        self.rows = [[part.strip() for part in l.split("|", 2)] for l in lines("explained.txt")]
        self.used = set()

    def reason(self, signature, case):
        for i, (signatures, case_pattern, reason) in enumerate(self.rows):
            if fnmatch.fnmatchcase(signature, signatures) and fnmatch.fnmatchcase(case, case_pattern):
                self.used.add(i)
                return reason
        return None

    def unused(self):
        return [" | ".join(row) for i, row in enumerate(self.rows) if i not in self.used]


class Formulas:
    """Documents that compute what a node without a peer should: formulas/NODEDEF.xml holds nodes in which {in1} and the like
    stand for how the input is fed; the node that gives the output is called `tried`, of several `tried_PORT`."""

    def __init__(self):
        self.texts = {f.stem: f.read_text() for f in sorted((HERE / "formulas").glob("*.xml"))}

    def build(self, signature, case):
        """The document of a case with the formula in place of the node, or None."""
        text = self.texts.get(signature.name)
        if text is None:
            return None
        plan = {"default": ("default", None), "written": ("written", None), "varied": ("varied", None), "signed": ("signed", None)}
        how, choice = plan.get(case, ("varied", tuple(case.split("=", 1))))

        class Formula(Maker):
            def body(self, writer, inputs, attributes):
                given = {name: fed for name, _, fed in inputs}
                fill = {}
                for port in signature.inputs:
                    fed = given.get(port.name)
                    if fed is None and port.geometric == "Nworld":
                        fed = writer.once("N_world", "normal", "vector3", ("space", "string", {"value": "world"}))
                    elif fed is None:
                        fed = {"value": port.value or ""}
                    fill[port.name] = " ".join(f'{k}="{v}"' for k, v in fed.items())
                body = re.sub(r"\{(\w+)\}", lambda m: fill[m[1]], text)
                writer.lines.append(body.rstrip())

            def link(self, port):
                return {"nodename": "tried_" + port.name if len(signature.outputs) > 1 else "tried"}

        return Formula(signature).build(how, choice)[0]


class Trial:
    """One element of one case: what became of it."""

    def __init__(self, case, element, type_):
        self.case, self.element, self.type = case, element, type_
        self.id = f"{case.stem}:{element}"
        self.fault = ""     # why it is not good
        self.no_peer = ""   # why there is nothing to compare with
        self.by_formula = False
        self.max = self.odd = self.undefined = self.rmse = self.furnace = self.peer_furnace = None
        self.bad = 0            # channels of ours that are no finite number
        self.is_bright = False  # in a white furnace, beyond what the peer is there: emission and sums are no fault

    @property
    def is_picture(self):
        return self.case.signature.is_closure

    @property
    def is_reflector(self):
        return self.type in ("BSDF", "surfaceshader", "material")

    def verdict(self):
        if self.fault:
            return "fails"
        if self.bad:
            return "differs"
        if self.no_peer or self.undefined == 1:
            return "no peer"
        if self.is_picture:
            good = self.rmse <= PICTURE_LIMIT and not self.is_bright
            return ("formula" if self.by_formula else "same") if good else "differs"
        if self.max <= VALUE_LIMIT:
            return "formula" if self.by_formula else "same"
        return "edges" if self.odd <= EDGE_LIMIT else "differs"


class Run:
    def __init__(self, arguments, signatures):
        self.arguments, self.explained, self.formulas = arguments, Explained(), Formulas()
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shaderx_signatures_"))
        self.compiler, self.pairs = Compiler(arguments.exe), Pairs(arguments.pair)
        self.drawn = ("live",) if arguments.live else INTERFACES
        self.peer = None
        if not arguments.without_peer:
            from materialx import Peer
            self.peer = Peer()
        self.trials = [Trial(c, e, t) for s in signatures for c in cases(s) for e, t in c.elements]

    def documents(self):
        files = {}
        for trial in self.trials:
            if trial.case.stem not in files:
                files[trial.case.stem] = self.folder / (trial.case.stem + ".mtlx")
                files[trial.case.stem].write_text(trial.case.text)
        return files

    def ours(self, files):
        for interface in INTERFACES:
            errors, _ = self.compiler.generate(list(files.values()), self.folder / interface, "--interface", interface)
            for trial in self.trials:
                if not (self.folder / interface / (file_name(trial.case.stem, trial.element) + ".frag")).exists() and not trial.fault:
                    why = errors.get(trial.case.stem + ".mtlx") or errors.get("?") or "no shader and no error"
                    trial.fault = f"{interface}: {why}"

    def theirs(self):
        out = self.folder / "peer"
        out.mkdir()
        if not self.peer:
            for trial in self.trials:
                trial.no_peer = "the peer is not here"
            return
        known = {}
        for trial in self.trials:
            formula = self.formulas.build(trial.case.signature, trial.case.name)
            trial.by_formula = formula is not None
            if trial.case.stem not in known:
                try:
                    known[trial.case.stem] = self.peer.read(formula or trial.case.text)
                except Exception as error:
                    known[trial.case.stem] = str(error)
            document = known[trial.case.stem]
            trial.no_peer = document if isinstance(document, str) else self.peer.generate(
                document, trial.element, out / file_name(trial.case.stem, trial.element))

    def pair(self, trial, folder):
        stem = self.folder / folder / file_name(trial.case.stem, trial.element)
        return [str(stem) + ".vert", str(stem) + ".frag"]

    def jobs(self):
        jobs = []
        for trial in self.trials:
            if trial.fault:
                continue
            job = {"id": trial.id, "pictures": str(self.folder / "grid.pfm"), "size": 32 if trial.is_picture else 48,
                   "samples": 1024 if trial.is_picture else 16, "tolerance": VALUE_LIMIT,
                   "ours": [self.pair(trial, i) for i in self.drawn]}
            if not trial.no_peer:
                job["theirs"] = self.pair(trial, "peer")
            jobs.append(job)
            if trial.is_reflector and trial.is_picture:
                jobs.append(dict(job, id=trial.id + ":furnace", environment=str(self.folder / "white.pfm"), samples=64,
                                 ours=[self.pair(trial, "live")]))
        return jobs

    def take(self, trial, answers):
        if trial.fault:
            return
        answer = answers[trial.id]
        if "died" in answer:
            trial.fault = f"the driver died ({answer['died']})"
            return
        if answer["theirs"] and not trial.no_peer:
            trial.no_peer = "its shader does not draw: " + " ".join(answer["theirs"].split())[:200]
        for interface, row in zip(self.drawn, answer["ours"]):
            said = row["glslang"] or row["draw"]
            trial.bad = max(trial.bad, row.get("bad", 0))
            if said and not trial.fault:
                trial.fault = f"{interface}: {'glslang: ' if row['glslang'] else ''}{' '.join(said.split())[:200]}"
            for key in ("max", "odd", "undefined", "rmse"):
                if key in row:
                    setattr(trial, key, max(getattr(trial, key) or 0, row[key]))
        furnace = answers.get(trial.id + ":furnace")
        if furnace and furnace["ours"] and "highest" in furnace["ours"][0]:
            trial.furnace = furnace["ours"][0]["highest"]
            trial.peer_furnace = furnace.get("peer", {}).get("highest")
            trial.is_bright = trial.furnace > max(FURNACE_LIMIT, (trial.peer_furnace or 0) * 1.01)

    def run(self):
        write_pictures(self.folder)
        files = self.documents()
        self.ours(files)
        self.theirs()
        jobs = self.jobs()
        shown = lambda done, all_: print(f"\r{done} of {all_} drawn", end="\n" if done == all_ else "", file=sys.stderr)
        answers = self.pairs.run(jobs, shown if sys.stderr.isatty() else None)
        for trial in self.trials:
            self.take(trial, answers)
        if not self.arguments.keep:
            shutil.rmtree(self.folder)


def number(v):
    return "" if v is None else f"{v:.2g}" if v < 0.1 else f"{v:.4g}"


def row_of(signature, trials, explained):
    """The table's row: the worst of a signature's trials."""
    order = ("same", "formula", "edges", "explained", "open", "no peer", "differs", "fails")
    worst, worst_trial, why = "same", trials[0], ""
    for trial in trials:
        verdict, reason = trial.verdict(), trial.fault or trial.no_peer
        if verdict not in GOOD:
            known = explained.reason(signature.name, trial.case.name)
            if known is not None:
                verdict, reason = "open" if known.startswith("open: ") else "explained", known
        if order.index(verdict) > order.index(worst):
            worst, worst_trial, why = verdict, trial, reason
    largest = lambda key: max((getattr(t, key) for t in trials if getattr(t, key) is not None), default=None)
    plain = [t for t in trials if t.verdict() in ("same", "formula")] or trials
    figures = plain if worst in ("same", "formula") else [worst_trial]
    of = lambda key: number(max((getattr(t, key) for t in figures if getattr(t, key) is not None), default=None))
    picture = trials[0].is_picture
    return dict(signature=signature.name, family=signature.family, cases=len({t.case.name for t in trials}), elements=len(trials),
                compared=sum(1 for t in trials if t.rmse is not None), max="" if picture else of("max"),
                odd="" if picture or worst != "edges" else of("odd"), rmse=of("rmse") if picture else "",
                furnace=number(largest("furnace")), verdict=worst, case=worst_trial.case.name if worst not in ("same", "formula") else "",
                reason=why)


def tried(arguments, names):
    """The rows of these signatures, and the trials."""
    ours = library(ROOT)
    run = Run(arguments, [ours[n] for n in names if n in ours])
    run.run()
    by_name = {}
    for trial in run.trials:
        by_name.setdefault(trial.case.signature.name, []).append(trial)
    rows = []
    for name in names:
        if name in ours:
            rows.append(row_of(ours[name], by_name[name], run.explained))
        else:
            reason = run.explained.reason(name, "default")
            rows.append(dict.fromkeys(COLUMNS, "") | dict(signature=name, verdict="fails" if reason is None else "explained",
                                                          reason=reason or "the library does not declare it"))
    return rows, run


def write_table(rows, run):
    with TABLE.open("w", newline="") as out:
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    count = lambda verdict, part=rows: sum(r["verdict"] == verdict for r in part)
    heads = [v for v in ("same", "formula", "edges", "explained", "open", "no peer", "differs", "fails") if count(v)]
    page = [f"""# Every signature

Written by `tools/signatures --all`; the whole table is [signatures.csv](signatures.csv). Commit {commit}, {run.compiler.version()},
MaterialX {run.peer.version}, Mesa's software driver.

{len(rows)} node signatures of the standard, {sum(int(r['elements'] or 0) for r in rows)} elements of {sum(int(r['cases'] or 0) for r in rows)} documents: each signature without
inputs, with all inputs written, with inputs that change over the sphere, with every value of its enumerations, each output. Each
element is generated in three interfaces, compiled by glslang, drawn, and compared with MaterialX's shader for the same document:
`same` is {VALUE_LIMIT} at most in every pixel for values (relative above 1), and {PICTURE_LIMIT} root of the mean squared difference at 1,024
samples for closures, which must not exceed {FURNACE_LIMIT} in a white furnace either (or what MaterialX has there: emission, sums). Where
MaterialX gives no finite number, as for the arc cosine of 2, nothing is compared; ours must be one all the same. `edges`: the same but for at most {EDGE_LIMIT:.1%} of the pixels, where a
node jumps. `formula`: MaterialX has no such node or cannot draw it, and ours is compared with its formula, written with other nodes.
`explained`: differs, and is listed below with the reason. `open`: differs, and nobody knows yet who is right.

| family | signatures | {' | '.join(heads)} |
|---|---|{'---|' * len(heads)}"""]
    for family in sorted({r["family"] for r in rows}):
        part = [r for r in rows if r["family"] == family]
        page.append(f"| {family or '(none)'} | {len(part)} | {' | '.join(str(count(v, part) or '') for v in heads)} |")
    page.append(f"| **all** | {len(rows)} | {' | '.join(str(count(v)) for v in heads)} |")
    page.append("\n| signature | verdict | case | max or RMSE | furnace | reason |\n|---|---|---|---|---|---|")
    for r in rows:
        if r["verdict"] not in ("same", "formula", "edges"):
            page.append(f"| {r['signature']} | {r['verdict']} | {r['case']} | {r['max'] or r['rmse']} | {r['furnace']} | {r['reason'].replace('|', '/')} |")
    PAGE.write_text("\n".join(page) + "\n")


def problems_of_table(names):
    """What is wrong with the table in docs/."""
    if not TABLE.exists():
        return ["docs/signatures.csv is not there"]
    rows = {r["signature"]: r for r in csv.DictReader(TABLE.open())}
    found = [f"{n} is not in the table" for n in names if n not in rows]
    found += [f"{n} is in the table and not in tests/peer/standard.txt" for n in rows if n not in names]
    found += [f"{n}: {r['verdict']}: {r['case']}: {r['reason']}" for n, r in rows.items() if r["verdict"] not in GOOD]
    return found


def show(rows, run):
    for trial in run.trials:
        figures = " ".join(f"{k} {number(getattr(trial, k))}" for k in ("max", "odd", "undefined", "rmse", "furnace", "peer_furnace") if getattr(trial, k) is not None)
        print(trial.id, trial.verdict(), figures, trial.fault or trial.no_peer)
    for row in rows:
        print(row["signature"], row["verdict"], row["case"], row["reason"])


def slice_of(names):
    return sorted(set(names[::SLICE]) | (set(lines("once_failed.txt")) & set(names)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--only")
    parser.add_argument("--documents", type=pathlib.Path)
    parser.add_argument("--live", action="store_true", help="draw one interface of the three")
    parser.add_argument("--keep", action="store_true", help="leave documents and shaders in the temporary folder, and say where")
    parser.add_argument("--exe", default=ROOT / "build/release/shaderx", type=pathlib.Path)
    parser.add_argument("--pair", default=ROOT / "build/release/tests/peer/shader_pair", type=pathlib.Path)
    arguments = parser.parse_args()
    names = lines("standard.txt")
    if arguments.documents:
        arguments.documents.mkdir(parents=True, exist_ok=True)
        for signature in library(ROOT).values():
            for case in cases(signature):
                (arguments.documents / (case.stem + ".mtlx")).write_text(case.text)
        return 0
    missing = under_judge("materialx")
    arguments.without_peer = bool(missing)
    if missing:
        print(f"skipped: comparing with MaterialX: {missing}")
        if arguments.all:
            return 3
    if arguments.only:
        rows, run = tried(arguments, [n for n in names if re.search(arguments.only, n)])
        show(rows, run)
        if arguments.keep:
            print(run.folder)
        return any(r["verdict"] not in GOOD for r in rows)
    if arguments.all:
        rows, run = tried(arguments, names)
        write_table(rows, run)
        bad = [f"{r['signature']}: {r['verdict']}: {r['case']}: {r['reason']}" for r in rows if r["verdict"] not in GOOD]
        bad += [f"explained.txt, but it does not differ: {line}" for line in run.explained.unused()]
        print(*bad, sep="\n")
        print(f"{len(rows)} signatures, {len(bad)} problems")
        return bool(bad)
    bad = problems_of_table(names)
    rows, _ = tried(arguments, slice_of(names))
    accepted = GOOD + (("no peer",) if missing else ())
    bad += [f"now: {r['signature']}: {r['verdict']}: {r['case']}: {r['reason']}" for r in rows if r["verdict"] not in accepted]
    print(*bad, sep="\n")
    print(f"{len(names)} signatures in the table, {len(rows)} tried anew, {len(bad)} problems")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
