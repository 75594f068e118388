#!/usr/bin/env python3
"""Draws the textures of the examples: make.py writes them, make.py --check says whether the files are what it draws.

Standard library only. Every picture is a function of its pixel and of a fixed seed, so a run repeats. All pictures are
256 x 256 and repeat without a seam in both directions, except film.png, which repeats in u alone.
"""
import math
import os
import random
import struct
import sys
import zlib

SIZE = 256
TAU = 2.0 * math.pi


# --- shapes and noise

def clamp(x, low=0.0, high=1.0):
    return low if x < low else high if x > high else x


def mix(a, b, t):
    return a + (b - a) * t


def mix3(a, b, t):
    return (mix(a[0], b[0], t), mix(a[1], b[1], t), mix(a[2], b[2], t))


def smoothstep(low, high, x):
    t = clamp((x - low) / (high - low))
    return t * t * (3.0 - 2.0 * t)


class Noise:
    """Gradient noise in about -0.7 … 0.7 that repeats after (columns, rows) lattice cells."""

    def __init__(self, seed, columns, rows):
        turn = random.Random(seed)
        self.columns, self.rows = columns, rows
        angles = [turn.random() * TAU for _ in range(columns * rows)]
        self.gradients = [(math.cos(a), math.sin(a)) for a in angles]

    def at(self, x, y):
        x0, y0 = math.floor(x), math.floor(y)
        fx, fy = x - x0, y - y0
        left, right = x0 % self.columns, (x0 + 1) % self.columns
        low, high = y0 % self.rows * self.columns, (y0 + 1) % self.rows * self.columns
        g = self.gradients
        a, b, c, d = g[low + left], g[low + right], g[high + left], g[high + right]
        u, v = fx * fx * (3.0 - 2.0 * fx), fy * fy * (3.0 - 2.0 * fy)
        bottom = mix(a[0] * fx + a[1] * fy, b[0] * (fx - 1) + b[1] * fy, u)
        top = mix(c[0] * fx + c[1] * (fy - 1), d[0] * (fx - 1) + d[1] * (fy - 1), u)
        return mix(bottom, top, v)


class Fractal:
    """Octaves of noise over the unit square, each twice as fine and half as strong as the one before."""

    def __init__(self, seed, columns, rows, octaves):
        self.levels = [(Noise(seed + i, columns << i, rows << i), columns << i, rows << i, 0.5 ** i)
                       for i in range(octaves)]

    def at(self, u, v):
        return sum(noise.at(u * columns, v * rows) * weight for noise, columns, rows, weight in self.levels)


def picture(pixel):
    """The rows of pixel(x, y), a tuple of numbers in 0 … 1 each; y counts from the top."""
    return [[pixel(x, y) for x in range(SIZE)] for y in range(SIZE)]


def normals(height, strength):
    """The tangent-space normal map of a seamless height(x, y) in pixels; green points up, as OpenGL has it."""
    rows = [[height(x, y) for x in range(SIZE)] for y in range(SIZE)]

    def pixel(x, y):
        dx = rows[y][(x + 1) % SIZE] - rows[y][x - 1]
        dy = rows[y - 1][x] - rows[(y + 1) % SIZE][x]
        n = (-dx * strength, -dy * strength, 2.0)
        length = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        return tuple(c / length * 0.5 + 0.5 for c in n)

    return picture(pixel)


# --- wood: a floor of four rows of planks, each plank sawn from a log of its own

PLANK = 64  # its width in pixels; its length is the picture's


class Wood:
    def __init__(self):
        turn = random.Random(11)
        self.planks = []
        for _ in range(SIZE // PLANK):
            self.planks.append({
                "joint": turn.randrange(SIZE),
                "heart": turn.uniform(0.1, 0.9) * PLANK,   # where the log's heart runs, across the plank
                "depth": turn.uniform(4.0, 22.0),          # and how far below the cut at the joint
                "slope": turn.uniform(0.16, 0.34),         # with which the cut leaves it
                "tone": turn.uniform(-0.16, 0.16),
                "red": turn.uniform(-0.03, 0.03),
                "phase": turn.uniform(0.0, 100.0),
            })
        # Spread the joints, so that no two rows end side by side.
        for row, plank in enumerate(self.planks):
            plank["joint"] = (40 + row * 100 + plank["joint"] // 8) % SIZE
        self.bend = Fractal(20, 4, 8, 3)
        self.fibre = Noise(30, 10, 150)
        self.fine = Noise(31, 24, 256)
        self.pore = Noise(32, 26, 128)
        self.cloud = Fractal(40, 3, 8, 2)

    def at(self, x, y):
        """(ring 0 … 1, fibre, pore 0 … 1, gap 0 … 1, plank) at a pixel."""
        row, across = y // PLANK, y % PLANK
        plank = self.planks[row]
        along = (x - plank["joint"]) % SIZE
        u, v = x / SIZE, y / SIZE
        bend = self.bend.at(u, v)
        rise = plank["depth"] + plank["slope"] * along
        radius = math.hypot(across + 0.5 - plank["heart"] + 9.0 * bend, rise + 7.0 * bend)
        turn = (radius / 6.5 + plank["phase"]) % 1.0
        # A year: slowly darker, then at once light again
        ring = turn ** 2.2 * (1.0 - smoothstep(0.88, 1.0, turn))
        fibre = 0.7 * self.fibre.at(u * 10, v * 150) + 0.6 * self.fine.at(u * 24, v * 256)
        pore = smoothstep(0.34, 0.5, self.pore.at(u * 26, v * 128)) * (0.35 + 0.65 * (1.0 - turn))
        edge = min(across + 0.5, PLANK - across - 0.5, along + 0.5, SIZE - along - 0.5)
        return ring, fibre, pore, 1.0 - smoothstep(0.6, 1.9, edge), plank

    def color(self, x, y):
        ring, fibre, pore, gap, plank = self.at(x, y)
        cloud = self.cloud.at(x / SIZE, y / SIZE)
        dark = clamp(0.20 + 0.55 * ring + 0.30 * fibre + 0.22 * cloud - plank["tone"])
        c = mix3((0.80, 0.50, 0.245), (0.37, 0.165, 0.062), dark)
        c = (c[0] + plank["red"], c[1], c[2] - 0.5 * plank["red"])
        c = mix3(c, (0.20, 0.085, 0.035), 0.65 * pore)
        return mix3(c, (0.055, 0.025, 0.012), 0.92 * gap)

    def roughness(self, x, y):
        ring, fibre, pore, gap, _ = self.at(x, y)
        return (clamp(0.40 - 0.12 * ring + 0.10 * fibre + 0.22 * pore + 0.35 * gap),)

    def height(self, x, y):
        ring, _, pore, gap, plank = self.at(x, y)
        across = y % PLANK
        along = (x - plank["joint"]) % SIZE
        edge = min(across + 0.5, PLANK - across - 0.5, along + 0.5, SIZE - along - 0.5)
        return 0.18 * ring - 0.35 * pore - 1.2 * gap - 0.8 * (1.0 - smoothstep(0.0, 5.0, edge))


# --- copper: scratches of a brush along u

class Brushed:
    def __init__(self):
        self.levels = [(Noise(50, 2, 64), 2, 64, 0.40), (Noise(51, 3, 128), 3, 128, 0.35),
                       (Noise(52, 6, 256), 6, 256, 0.30)]

    def pixel(self, x, y):
        u, v = x / SIZE, (y + 0.37) / SIZE
        return (clamp(0.5 + sum(n.at(u * c, v * r) * w for n, c, r, w in self.levels)),)


# --- soap: a film that thins towards the top, stirred by slow currents

class Film:
    def __init__(self):
        self.stir = Fractal(60, 3, 3, 3)
        self.other = Fractal(70, 3, 3, 3)
        self.flow = Fractal(80, 2, 4, 4)

    def pixel(self, x, y):
        u, v = x / SIZE, y / SIZE
        # Twice bent by itself: currents, not clouds
        for strength in (0.16, 0.11):
            a, b = self.stir.at(u, v), self.other.at(u, v)
            u, v = u + strength * a, v + strength * b
        sink = y / SIZE
        return (clamp(0.08 + 0.72 * sink + 0.34 * self.flow.at(u, v)),)


# --- velvet: a damask of quatrefoils and buds, in half drop

class Damask:
    def __init__(self):
        self.pile = Fractal(90, 16, 16, 3)

    @staticmethod
    def motif(x, y):
        """Above 0 within the figure, about the distance to its edge in units of the cell; the centre is (0, 0)."""
        r, a = math.hypot(x, y), math.atan2(y, x)
        petals = 0.20 + 0.085 * math.cos(4.0 * a) - r                          # the flower
        hole = 0.018 - abs(r - 0.125 - 0.035 * math.cos(4.0 * a))              # a line within it
        heart = 0.052 - r
        x, y = abs(x), abs(y)
        if x < y:
            x, y = y, x
        bud = 0.052 * (1.0 - ((x - 0.375) / 0.085) ** 2) - y                   # a bud beyond each petal
        d, e = 0.7071 * (x + y), 0.7071 * (x - y)
        leaf = 0.036 * (1.0 - ((d - 0.285) / 0.075) ** 2) - e                  # and a leaf between two
        return max(min(petals, -hole), heart, bud, leaf)

    def pixel(self, x, y):
        u, v = (x + 0.5) / SIZE, (y + 0.5) / SIZE
        inside = -1.0
        for cx, cy in ((0.0, 0.0), (0.5, 0.5)):
            # The cell is a half of the picture, so the motif is drawn at twice its size.
            dx, dy = (u - cx + 0.5) % 1.0 - 0.5, (v - cy + 0.5) % 1.0 - 0.5
            inside = max(inside, self.motif(dx * 1.35, dy * 1.35))
        figure = smoothstep(-0.006, 0.006, inside)
        return (clamp(0.06 + 0.86 * figure + 0.10 * self.pile.at(u, v)),)


# --- ceramic: a painted tile, eight times the same wedge

class Tile:
    def __init__(self):
        self.hand = Fractal(100, 5, 5, 3)   # what a brush does to a line
        self.wash = Fractal(110, 8, 8, 3)

    def pixel(self, x, y):
        u, v = (x + 0.5) / SIZE, (y + 0.5) / SIZE
        hand = 0.010 * self.hand.at(u, v)
        wash = self.wash.at(u, v)
        px, py = abs(u - 0.5), abs(v - 0.5)
        if py > px:
            px, py = py, px
        r, a = math.hypot(px, py), math.atan2(py, px)
        qx, qy = 0.5 - px, 0.5 - py                    # from the tile's corner
        q = math.hypot(qx, qy)

        def ink(distance, soft=0.005):
            return smoothstep(-soft, soft, distance + hand)

        white = (0.925, 0.915, 0.880)
        cobalt = mix3((0.055, 0.135, 0.440), (0.110, 0.235, 0.580), clamp(0.5 + 1.1 * wash))
        sky = mix3((0.400, 0.560, 0.790), (0.540, 0.680, 0.860), clamp(0.5 + 1.1 * wash))
        ochre = mix3((0.820, 0.560, 0.130), (0.910, 0.690, 0.260), clamp(0.5 + wash))
        c = mix3(white, (0.875, 0.885, 0.890), clamp(0.5 + wash))

        star = 0.205 + 0.075 * math.cos(8.0 * a) - r
        c = mix3(c, sky, ink(star))
        c = mix3(c, cobalt, ink(0.010 - abs(star)))
        c = mix3(c, white, ink(0.115 + 0.022 * math.cos(8.0 * a) - r))
        c = mix3(c, ochre, ink(0.085 - r))
        c = mix3(c, cobalt, ink(0.007 - abs(r - 0.085)))
        c = mix3(c, cobalt, ink(0.030 - r))
        petal = 0.034 * (1.0 - ((px - 0.335) / 0.058) ** 2) - py
        c = mix3(c, cobalt, ink(petal))
        c = mix3(c, sky, ink(petal - 0.016))
        c = mix3(c, cobalt, ink(0.0085 - abs(q - 0.205)))
        c = mix3(c, ochre, ink(0.0085 - abs(q - 0.178)))
        c = mix3(c, cobalt, ink(0.130 + 0.030 * math.cos(8.0 * math.atan2(qy, qx)) - q))
        c = mix3(c, white, ink(0.062 - q))
        c = mix3(c, ochre, ink(0.040 - q))
        c = mix3(c, cobalt, ink(0.013 - math.hypot(px - 0.425, py - 0.0)))
        grout = smoothstep(0.0085, 0.0045, qx) if qx < 0.0085 else 0.0
        return mix3(c, (0.58, 0.57, 0.54), grout)


# --- files

def encode(rows):
    """An 8-bit PNG of rows of 1- or 3-tuples; each line takes the filter whose bytes are smallest in sum."""
    channels = len(rows[0][0])
    previous = bytes(SIZE * channels)
    lines = []
    for row in rows:
        line = bytes(int(clamp(c) * 255.0 + 0.5) for pixel in row for c in pixel)
        left = bytes(channels) + line[:-channels]
        candidates = [
            (0, line),
            (1, bytes((a - b) & 255 for a, b in zip(line, left))),
            (2, bytes((a - b) & 255 for a, b in zip(line, previous))),
        ]
        kind, best = min(candidates, key=lambda item: sum(min(b, 256 - b) for b in item[1]))
        lines.append(bytes([kind]) + best)
        previous = line

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    header = struct.pack(">IIBBBBB", SIZE, SIZE, 8, 2 if channels == 3 else 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(lines), 9)) +
            chunk(b"IEND", b""))


def decode(data):
    """The sample bytes of a PNG that encode wrote."""
    at, packed, channels = 8, b"", 1
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if name == b"IHDR":
            channels = 3 if body[9] == 2 else 1
        if name == b"IDAT":
            packed += body
        at += length + 12
    raw, stride = zlib.decompress(packed), SIZE * channels
    previous, out = bytearray(stride), bytearray()
    for y in range(SIZE):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            if kind == 1 and i >= channels:
                line[i] = (line[i] + line[i - channels]) & 255
            elif kind == 2:
                line[i] = (line[i] + previous[i]) & 255
        out += line
        previous = line
    return bytes(out)


def textures():
    wood = Wood()
    return {
        "wood_color.png": lambda: picture(wood.color),
        "wood_roughness.png": lambda: picture(wood.roughness),
        "wood_normal.png": lambda: normals(wood.height, 0.55),
        "brushed.png": lambda: picture(Brushed().pixel),
        "film.png": lambda: picture(Film().pixel),
        "damask.png": lambda: picture(Damask().pixel),
        "tile_color.png": lambda: picture(Tile().pixel),
    }


def main():
    folder = os.path.dirname(os.path.abspath(__file__))
    if sys.argv[1:] not in ([], ["--check"]):
        print("usage: make.py [--check]", file=sys.stderr)
        return 2
    wrong = 0
    for name, draw in textures().items():
        path = os.path.join(folder, name)
        data = encode(draw())
        if not sys.argv[1:]:
            with open(path, "wb") as file:
                file.write(data)
            print("%s: %d bytes" % (name, len(data)))
            continue
        with open(path, "rb") as file:
            old, new = decode(file.read()), decode(data)
        # One step of 255 is left to the last bit of another machine's sine.
        if len(old) != len(new) or any(abs(a - b) > 1 for a, b in zip(old, new)):
            print("%s is not what make.py draws" % name)
            wrong = 1
    return wrong


sys.exit(main())
