"""What the source checks share: C++ text without comments, the rooms, and the report. A module, not a program."""
import os
import re
import sys

# Room → number (docs/design.md, "Rooms and the one rule"). A room may include lower numbers and itself.
ROOM_NUMBERS = {
    "base": 0,
    "ir": 1, "doc": 1, "image": 1,
    "sl": 2, "graph": 2, "passes": 2, "scene": 2,
    "targets": 3, "cpu": 3,
    "compile": 4,
    "draw": 5, "oracle": 5, "render": 5,
    "apps": 6,
}
# Their folders are rooms of their own.
GROUPS = ("targets", "apps")

TOKEN = re.compile(
    r"""(?P<raw>R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)")
      | (?P<text>"(?:\\.|[^"\\\n])*")
      | (?P<number>\b\d[\w.']*)
      | (?P<char>'(?:\\.|[^'\\\n])*')
      | (?P<line>//[^\n]*)
      | (?P<block>/\*.*?\*/)""",
    re.VERBOSE | re.DOTALL)


def without_comments(text):
    """The same text with every comment turned to blanks, line ends kept, so that line numbers stay."""
    def blank(match):
        if match.group("line") is None and match.group("block") is None:
            return match.group(0)
        return re.sub(r"[^\n]", " ", match.group(0))
    return TOKEN.sub(blank, text)


def room_of(path):
    """The room of a path relative to src: "ir/ops.h" is of "ir", "targets/glsl/print.h" of "targets/glsl"."""
    parts = path.split("/")
    if parts[0] in GROUPS and len(parts) > 1:
        return parts[0] + "/" + parts[1]
    return parts[0]


def number_of(room):
    """None for what is no room."""
    return ROOM_NUMBERS.get(room.split("/")[0])


def sources(root, names=(".h", ".cpp", ".def", ".inc")):
    """(path relative to src, text) of every file under ROOT/src whose name ends so, in order."""
    source = os.path.join(root, "src")
    for folder, folders, files in os.walk(source):
        folders.sort()
        for file in sorted(files):
            if not file.endswith(tuple(names)):
                continue
            path = os.path.join(folder, file)
            with open(path, encoding="utf-8") as opened:
                yield os.path.relpath(path, source), opened.read()


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def write(root, path, text):
    """For self-tests: a file of a planted tree."""
    whole = os.path.join(root, "src", path)
    os.makedirs(os.path.dirname(whole), exist_ok=True)
    with open(whole, "w", encoding="utf-8") as file:
        file.write(text)


def run(check, self_test):
    """The main program of a check. check(root) → list of "file:line: what"; self_test() raises when it is broken."""
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        print("every planted violation was found")
        return 0
    if sys.argv[1:]:
        print("usage: %s [--self-test]" % os.path.basename(sys.argv[0]), file=sys.stderr)
        return 2
    found = check(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))
    for line in found:
        print(line)
    return 1 if found else 0


def expect(check, root, planted):
    """For self-tests: the check finds exactly one line for each planted "file:line", and nothing else."""
    found = check(root)
    places = sorted(":".join(line.split(":")[:2]) for line in found)
    if places != sorted(planted):
        raise SystemExit("the check is broken: expected %s, found\n%s" % (sorted(planted), "\n".join(found)))
