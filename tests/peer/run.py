"""What tools/signatures and tools/testsuite share: the compiler, the renderer of pairs, the judges, and the files between."""
import array
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


class Pairs:
    """Runs the jobs of shader_pair on as many processes as there are processors. One that dies takes one job with it."""

    def __init__(self, exe, workers=None):
        self.exe, self.workers = exe, workers or os.cpu_count() or 1

    def run(self, jobs, progress=None):
        """The answers by the jobs' ids. Few samples need no good code of the driver, whose making is what takes the time."""
        answers = {}
        for code in ("nopt,no_quad_lod", "no_quad_lod"):
            part = [j for j in jobs if (j["samples"] * j["size"] < 4096) == code.startswith("nopt")]
            answers |= self._run(part, code, progress)
        return answers

    def _run(self, jobs, code, progress):
        answers, lock, left = {}, threading.Lock(), list(reversed(jobs))
        environment = dict(os.environ, GALLIVM_PERF=code, LP_NUM_THREADS="1", MESA_SHADER_CACHE_DISABLE="true")

        def worker():
            while True:
                process = subprocess.Popen([self.exe], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)
                while True:
                    with lock:
                        job = left.pop() if left else None
                    if job is None:
                        process.stdin.close()
                        process.wait()
                        return
                    line = ""
                    try:
                        process.stdin.write(json.dumps(job) + "\n")
                        process.stdin.flush()
                        line = process.stdout.readline()
                    except BrokenPipeError:
                        pass
                    with lock:
                        answers[job["id"]] = json.loads(line) if line else {"theirs": "", "ours": [], "died": process.wait()}
                        if progress:
                            progress(len(answers), len(jobs))
                    if not line:
                        break

        threads = [threading.Thread(target=worker) for _ in range(self.workers)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        return answers
