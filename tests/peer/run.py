"""What tools/signatures and tools/testsuite share: the compiler, the renderer of pairs, the judges, and the files between."""
import array
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
INTERFACES = ("complete", "live", "baked")


def write_pfm(path, width, height, pixel):
    """A picture of floats: pixel(x, y) gives red, green and blue; y = 0 is the bottom row."""
    values = array.array("f", (c for y in range(height) for x in range(width) for c in pixel(x, y)))
    if sys.byteorder == "big":
        values.byteswap()
    pathlib.Path(path).write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + values.tobytes())


def write_pictures(folder):
    """The pictures of every run: `grid.pfm` for all textures, `white.pfm`, a world of radiance 1."""
    write_pfm(folder / "grid.pfm", 256, 256,
              lambda x, y: (0.8 if (x // 32 ^ y // 32) & 1 else 0.2, x / 255, y / 255))
    write_pfm(folder / "white.pfm", 8, 4, lambda x, y: (1, 1, 1))


def under_judge(name):
    """Starts this program anew with a judge's Python, once; returns what the judge could not do, or "" when it is here."""
    if os.environ.get("SHADERX_JUDGE") == name:
        return ""
    had = subprocess.run([ROOT / "tools/judges", name], capture_output=True, text=True)
    if had.returncode:
        return had.stderr.strip().splitlines()[-1]
    python = ROOT / had.stdout.strip() / "bin/python"
    os.environ["SHADERX_JUDGE"] = name
    os.execv(python, [str(python), *sys.argv])


def file_name(stem, element):
    """How `shaderx generate` calls the files of an element."""
    return f"{stem}.{re.sub(r'[^A-Za-z0-9_]', '_', element)}"


class Compiler:
    def __init__(self, exe):
        self.exe = exe

    def version(self):
        return subprocess.run([self.exe, "--version"], capture_output=True, text=True).stdout.strip()

    def generate(self, documents, out, *options):
        """Compiles documents, many in one call. Returns the first error of each file that has one, and the exit codes."""
        out.mkdir(parents=True, exist_ok=True)
        errors, codes = {}, set()
        for start in range(0, len(documents), 500):
            part = [str(d) for d in documents[start : start + 500]]
            ran = subprocess.run([self.exe, "generate", *part, "-o", out, *options], capture_output=True, text=True,
                                 errors="replace")
            codes.add(ran.returncode)
            for line in ran.stderr.splitlines():
                found = re.match(r"(.*?\.mtlx)(?::\d+)*: (?:internal )?error: (.*)", line)
                if found:
                    errors.setdefault(pathlib.Path(found[1]).name, found[2])
                elif "internal error" in line or ran.returncode not in (0, 1):
                    errors.setdefault("?", line)
        return errors, codes


class Answers:
    """Answers of shader_pair to jobs of the same texts and settings, kept in build/peer: a run that was broken off goes on,
    and one after a change draws what the change reaches."""

    def __init__(self):
        self.file = ROOT / "build/peer/answers.jsonl"
        self.file.parent.mkdir(parents=True, exist_ok=True)
        self.known = {}
        if self.file.exists():
            for line in self.file.read_text().splitlines():
                try:
                    kept = json.loads(line)
                    self.known[kept["key"]] = kept["answer"]
                except ValueError:
                    pass  # the last line of a run that was broken off
        self.renderer = hashlib.sha256()
        for source in sorted([ROOT / "tests/peer/pair.cpp", *(ROOT / "src/draw").iterdir(), *(ROOT / "src/scene").iterdir()]):
            self.renderer.update(source.read_bytes())

    def key(self, job):
        made = self.renderer.copy()
        theirs = job.get("theirs", [])
        for file in [*([theirs] if isinstance(theirs, str) else theirs), *(f for pair in job["ours"] for f in pair)]:
            made.update(pathlib.Path(file).read_bytes() + b"\0")
        plain = {k: pathlib.Path(v).name if k in ("pictures", "environment") else v for k, v in job.items()
                 if k not in ("id", "theirs", "ours")}
        made.update(json.dumps(plain, sort_keys=True).encode())
        return made.hexdigest()

    def keep(self, key, answer):
        self.known[key] = answer
        with self.file.open("a") as out:
            out.write(json.dumps({"key": key, "answer": answer}) + "\n")


class Pairs:
    """Runs the jobs of shader_pair on as many processes as there are processors. One that dies takes one job with it."""

    def __init__(self, exe, workers=None):
        self.exe, self.workers = exe, workers or int(os.environ.get("SHADERX_WORKERS", 0)) or os.cpu_count() or 1
        self.kept = Answers()

    def run(self, jobs, progress=None):
        """The answers by the jobs' ids. Few samples need no good code of the driver, whose making is what takes the time."""
        keys = {j["id"]: self.kept.key(j) for j in jobs}
        answers = {i: self.kept.known[k] for i, k in keys.items() if k in self.kept.known}
        left = [j for j in jobs if j["id"] not in answers]
        for code in ("nopt,no_quad_lod", "no_quad_lod"):
            part = [j for j in left if (j["samples"] * j["size"] < 4096) == code.startswith("nopt")]
            self._run(part, code, keys, answers, progress)
        return answers

    def _run(self, jobs, code, keys, answers, progress):
        lock, left = threading.Lock(), list(reversed(jobs))
        environment = dict(os.environ, GALLIVM_PERF=code, LP_NUM_THREADS="1", MESA_SHADER_CACHE_DISABLE="true")

        def take():
            with lock:
                return left.pop() if left else None

        def ask(process, job):
            try:
                process.stdin.write(json.dumps(job) + "\n")
                process.stdin.flush()
                return process.stdout.readline()
            except BrokenPipeError:
                return ""

        def answered(job, answer):
            with lock:
                answers[job["id"]] = answer
                if "died" not in answer:
                    self.kept.keep(keys[job["id"]], answer)
                if progress:
                    progress(len(answers), len(keys))

        def worker():
            process = None
            while job := take():
                process = process or subprocess.Popen([self.exe], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                                      env=environment)
                line = ask(process, job)
                if line:
                    answered(job, json.loads(line))
                else:
                    answered(job, {"theirs": "", "ours": [], "died": process.wait()})
                    process = None
            if process:
                process.stdin.close()
                process.wait()

        threads = [threading.Thread(target=worker) for _ in range(self.workers)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
