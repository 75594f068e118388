"""The node signatures of the built-in library, and documents that try each of them.

A signature's documents are its cases: `default` names the nodedef and writes nothing; `written` writes a value of its own
on every input; `varied` feeds every input that takes numbers with something that changes over the sphere; `signed` does so
with values below 0 and above 1 where the declaration gives no range; closures have a case for each group of inputs in which
makers are known to differ (GROUPS), which the other cases leave alone; and one case for each further value of an
enumeration or a switch (`scatter_mode=RT`). Each has one element to draw for each output.
"""
import pathlib
import xml.etree.ElementTree as xml
from xml.sax.saxutils import quoteattr

SIZES = {"float": 1, "integer": 1, "vector2": 2, "vector3": 3, "vector4": 4, "color3": 3, "color4": 4, "matrix33": 9,
         "matrix44": 16}
FREE = (0.1, 0.9)     # where a declaration gives no range
SIGNED = (-1.7, 1.9)  # the same, in the case `signed`

# Ranges that a node needs to show something, by the input's name: they come before the declaration's.
NEEDED = {"emission_luminance": (0.0, 0.5)}  # 1000 would hide all else

# The same where a declaration gives no range.
RANGES = {"ior": (1.2, 2.2), "exponent": (2.0, 6.0), "thinfilm_thickness": (100.0, 600.0), "thinfilm_ior": (1.2, 1.8),
          "lacunarity": (1.7, 2.3), "temperature": (2000.0, 9000.0), "octaves": (1, 4), "extinction": (1.0, 3.0),
          "operationorder": (0, 1), "min": (0.0, 0.3), "max": (0.6, 1.0), "in_low": (0.0, 0.2), "inlow": (0.0, 0.2),
          "inhigh": (0.7, 1.0)}

# Texts that a declaration gives neither a list nor a value for.
TEXTS = {"geomprop": "tone", "varname": "tone", "attrname": "tone"}

GROUPS = ("thinfilm", "transmission", "specTrans", "iridescence", "opacity", "useSpecularWorkflow")


class Port:
    """An input or output of a signature."""

    def __init__(self, element):
        get = element.get
        self.name, self.type, self.value = get("name"), get("type"), get("value")
        self.geometric = get("defaultgeomprop")
        self.uniform = get("uniform") == "true"
        self.choices = self._choices(get("enum"), get("enumvalues"))
        # What is usual before what is possible: an index of refraction from 1, not from 0.
        low, high = get("uisoftmin") or get("uimin"), get("uisoftmax") or get("uimax")
        self.range = NEEDED.get(self.name)
        if self.range is None and low is not None and high is not None:
            self.range = float(low.split(",")[0]), float(high.split(",")[0])

    def _choices(self, names, values):
        """The values that an enumeration or a switch can have, as text."""
        if self.type == "boolean" and self.uniform:
            return ["false", "true"]
        if not names:
            return []
        if not values:
            return [n.strip() for n in names.split(",")]
        parts, size = [v.strip() for v in values.split(",")], SIZES.get(self.type, 1)
        return [", ".join(parts[i : i + size]) for i in range(0, len(parts), size)]


class Signature:
    def __init__(self, element, family):
        self.name, self.node, self.family = element.get("name"), element.get("node"), family
        self.version = element.get("version") if element.get("isdefaultversion") != "true" else None
        self.base = element.get("inherit")
        self.inputs = [Port(e) for e in element.findall("input")]
        self.outputs = [Port(e) for e in element.findall("output")]

    def inherit(self, base):
        """Takes what it does not declare itself from another signature."""
        own = {p.name: p for p in self.inputs}
        self.inputs = [own.pop(p.name, p) for p in base.inputs] + list(own.values())
        self.outputs = self.outputs or base.outputs

    @property
    def type(self):
        return self.outputs[0].type if len(self.outputs) == 1 else "multioutput"

    @property
    def is_closure(self):
        return self.outputs[0].type in ("BSDF", "EDF", "VDF", "surfaceshader", "volumeshader", "displacementshader", "material")


def library(root):
    """The signatures that the built-in library declares, by name."""
    found = {}
    for file in sorted(pathlib.Path(root, "nodes").glob("*.mtlx")):
        for element in xml.parse(file).getroot().iter("nodedef"):
            found[element.get("name")] = Signature(element, file.stem)
    for signature in found.values():
        if signature.base:
            signature.inherit(found[signature.base])
    return found


def text(values):
    return ", ".join(f"{v:.6g}" for v in values)


class Writer:
    """Writes a document: nodes, and what varies over the sphere to feed them with."""

    def __init__(self):
        self.lines, self.count, self.known = [], 0, set()

    def node(self, category, type_, inputs, name=None, **attributes):
        """`inputs`: (name, type, attributes) each. Returns the node's name."""
        if name is None:
            self.count += 1
            name = f"s{self.count}"
        more = "".join(f" {k}={quoteattr(v)}" for k, v in attributes.items() if v)
        self.lines.append(f'  <{category} name="{name}" type="{type_}"{more}>')
        for port, port_type, how in inputs:
            said = "".join(f" {k}={quoteattr(v)}" for k, v in how.items())
            self.lines.append(f'    <input name="{port}" type="{port_type}"{said}/>')
        self.lines.append(f"  </{category}>")
        return name

    def once(self, name, category, type_, *inputs):
        if name not in self.known:
            self.known.add(name)
            self.node(category, type_, inputs, name=name)
        return {"nodename": name}

    def position(self):
        return self.once("P", "position", "vector3", ("space", "string", {"value": "world"}))

    def waves(self, type_, base, factors, phase, low, high):
        """low … high, as the sine of what `base` gives."""
        size = SIZES[type_]
        scaled = self.node("multiply", type_, [("in1", type_, base), ("in2", type_, {"value": text(factors)})])
        moved = self.node("add", type_, [("in1", type_, {"nodename": scaled}), ("in2", type_, {"value": text([phase + 0.7 * i for i in range(size)])})])
        wave = self.node("sin", type_, [("in", type_, {"nodename": moved})])
        half, middle = (high - low) / 2, (high + low) / 2
        wide = self.node("multiply", type_, [("in1", type_, {"nodename": wave}), ("in2", "float", {"value": text([half])})])
        return {"nodename": self.node("add", type_, [("in1", type_, {"nodename": wide}), ("in2", "float", {"value": text([middle])})])}

    def varied(self, type_, k, low, high):
        """Something of that type that changes over the sphere, for the input number k."""
        link = lambda how, name, t: (name, t, how)
        if type_ == "float":
            a = (1.3 + 0.31 * k % 1.7, 1.9 - 0.53 * k % 1.1, 0.8 + 0.77 * k % 1.3)
            dot = self.node("dotproduct", "float", [link(self.position(), "in1", "vector3"), ("in2", "vector3", {"value": text(a)})])
            return self.waves("float", {"nodename": dot}, [1.0], 0.9 * k, low, high)
        if type_ == "integer":
            smooth = self.varied("float", k, low, high + 0.999)
            return {"nodename": self.node("floor", "integer", [link(smooth, "in", "float")])}
        if type_ == "boolean":
            smooth = self.varied("float", k, 0.0, 1.0)
            return {"nodename": self.node("ifgreater", "boolean", [link(smooth, "value1", "float"), ("value2", "float", {"value": "0.5"})])}
        if type_ == "vector3":
            a = (1.7 + 0.41 * k % 1.3, 1.5 - 0.37 * k % 0.9, 1.2 + 0.59 * k % 1.1)
            return self.waves("vector3", self.position(), a, 0.8 * k, low, high)
        if type_ == "color3":
            return {"nodename": self.node("convert", "color3", [link(self.varied("vector3", k, low, high), "in", "vector3")])}
        if type_ in ("vector4", "color4"):
            first = "vector3" if type_ == "vector4" else "color3"
            return {"nodename": self.node("combine2", type_, [link(self.varied(first, k, low, high), "in1", first),
                                                             link(self.varied("float", k + 7, low, high), "in2", "float")])}
        if type_ == "vector2":
            return {"nodename": self.node("combine2", "vector2", [link(self.varied("float", k, low, high), "in1", "float"),
                                                                 link(self.varied("float", k + 5, low, high), "in2", "float")])}
        size = 3 if type_ == "matrix33" else 4
        rows = []
        for i in range(size):
            row = self.varied("vector3", k + i, -0.3, 0.4)
            if size == 4:
                row = {"nodename": self.node("combine2", "vector4", [link(row, "in1", "vector3"), ("in2", "float", {"value": "0.2"})])}
            unit = text([1.5 if i == j else 0.0 for j in range(size)])
            rows.append({"nodename": self.node("add", f"vector{size}", [link(row, "in1", f"vector{size}"), ("in2", f"vector{size}", {"value": unit})])})
        return {"nodename": self.node("creatematrix", type_, [link(r, f"in{i + 1}", f"vector{size}") for i, r in enumerate(rows)])}

    def direction(self, property_, k):
        """A unit vector near a geometric property's."""
        category = {"N": "normal", "T": "tangent", "B": "bitangent"}[property_[0]]
        space = "object" if property_.endswith("object") else "world"
        own = self.once(f"{category}_{space}", category, "vector3", ("space", "string", {"value": space}))
        bend = self.varied("vector3", k, -0.25, 0.25)
        bent = self.node("add", "vector3", [("in1", "vector3", own), ("in2", "vector3", bend)])
        return {"nodename": self.node("normalize", "vector3", [("in", "vector3", {"nodename": bent})])}

    def closure(self, type_, k, role=""):
        """A closure or a shader to feed an input with."""
        colour = {"value": text([0.2 + 0.15 * (k % 4), 0.75 - 0.2 * (k % 3), 0.45 + 0.1 * (k % 5)])}
        if type_ == "BSDF" and role in ("top", "materialTop"):
            return self.node("dielectric_bsdf", "BSDF", [("roughness", "vector2", {"value": "0.1, 0.1"}), ("ior", "float", {"value": "1.6"})])
        if type_ == "BSDF":
            return self.node("oren_nayar_diffuse_bsdf", "BSDF", [("color", "color3", colour), ("roughness", "float", {"value": "0.3"})])
        if type_ == "EDF":
            return self.node("uniform_edf", "EDF", [("color", "color3", colour)])
        if type_ == "VDF":
            return self.node("absorption_vdf", "VDF", [("absorption", "vector3", colour)])
        if type_ == "surfaceshader":
            return self.node("surface_unlit", "surfaceshader", [("emission_color", "color3", colour)])
        if type_ == "displacementshader":
            return self.node("displacement", "displacementshader", [("displacement", "float", {"value": "0.05"})])
        if type_ == "volumeshader":
            return self.node("volume", "volumeshader", [("vdf", "VDF", {"nodename": self.closure("VDF", k)})])
        if type_ == "material":
            return self.node("surfacematerial", "material", [("surfaceshader", "surfaceshader", {"nodename": self.closure("surfaceshader", k)})])
        return None

    def finish(self):
        return '<?xml version="1.0"?>\n<materialx version="1.39">\n' + "\n".join(self.lines) + "\n</materialx>\n"


def constant(port, k):
    """A value of its own for an input, as text; None where there is none."""
    if port.choices:
        others = [c for c in port.choices if c != port.value]
        return others[0] if others else port.value
    low, high = port.range or RANGES.get(port.name, FREE)
    if port.type == "integer":
        return str(int(round(low + (high - low) * 0.6)) if port.range or port.name in RANGES else 2 + k % 2)
    if port.type == "boolean":
        return "false" if port.value == "true" else "true"
    if port.type in ("matrix33", "matrix44"):
        n = 3 if port.type == "matrix33" else 4
        return text([(1.4 + 0.2 * i if i == j else 0.1 * ((i * n + j + k) % 5) - 0.2) for i in range(n) for j in range(n)])
    if port.type in SIZES:
        return text([low + (high - low) * (0.25 + 0.5 * ((0.37 * k + 0.29 * i) % 1.0)) for i in range(SIZES[port.type])])
    if port.type == "filename":
        return "grid.png"
    return port.value or TEXTS.get(port.name)


def group_of(port):
    """Inputs that switch on what closures may differ in have a case of their own, so that it does not hide the rest."""
    plain = port.name.replace("_", "")
    return next((g for g in GROUPS if plain.startswith(g)), None)


def inner(range_):
    """A range without its ends, where many nodes are at an edge of what they do."""
    low, high = range_
    return low + 0.1 * (high - low), high - 0.1 * (high - low)


class Case:
    """One document of a signature: its text, and the elements to draw, each with its output's type."""

    def __init__(self, signature, name, build):
        self.signature, self.name = signature, name
        self.stem = signature.name + "-" + "".join(c if c.isalnum() else "_" for c in name)
        self.text, self.elements = build


class Maker:
    def __init__(self, signature):
        self.signature = signature

    def feed(self, writer, port, k, how, choice):
        """The attributes of an input in one case; None leaves it out."""
        if choice and choice[0] == port.name:
            return {"value": choice[1]}
        if self.signature.is_closure and group_of(port) not in (None, how):
            return None
        made = writer.closure(port.type, k, port.name)
        if made:
            return {"nodename": made}
        if port.type in ("string", "filename", "geomname") or port.uniform or how == "written" or port.choices:
            if how == "written" and port.geometric:  # a value there is no value: MaterialX does not read it
                return None
            value = constant(port, k) if how == "written" or not port.choices else port.value
            return {"value": value} if value else None
        if port.type not in SIZES and port.type != "boolean":
            return None
        if port.geometric and port.type == "vector3" and port.geometric[0] in "NTB":
            return writer.direction(port.geometric, k)
        if port.range or port.name in RANGES:
            low, high = inner(port.range or RANGES[port.name])
        elif port.type == "integer":
            low, high = (-4, 6) if how == "signed" else (0, 3)
        else:
            low, high = SIGNED if how == "signed" else FREE
        if port.type == "integer":
            low, high = round(low), round(high)
        return writer.varied(port.type, k, low, high)

    def build(self, how, choice=None):
        s, writer = self.signature, Writer()
        inputs = []
        if how != "default":
            for k, port in enumerate(s.inputs):
                fed = self.feed(writer, port, k, how, choice)
                if fed is not None:
                    inputs.append((port.name, port.type, fed))
        attributes = {"nodedef": s.name} if how == "default" else {"version": s.version}
        self.body(writer, inputs, attributes)
        elements = self.show(writer)
        return writer.finish(), elements

    def body(self, writer, inputs, attributes):
        writer.node(self.signature.node, self.signature.type, inputs, name="tried", **attributes)

    def show(self, writer):
        """Writes what makes the outputs visible; the elements to draw."""
        elements = []
        for port in self.signature.outputs:
            elements.append((self.show_one(writer, port, self.link(port)), port.type))
        return elements

    def link(self, port):
        """How something is connected to an output of what is tried."""
        return {"nodename": "tried"} | ({"output": port.name} if len(self.signature.outputs) > 1 else {})

    def material(self, writer, shader, **more):
        inputs = [("surfaceshader", "surfaceshader", shader)] + [(k, k, v) for k, v in more.items()]
        return writer.node("surfacematerial", "material", inputs, name="shown")

    def show_one(self, writer, port, how):
        surface = lambda name, type_, link: {"nodename": writer.node("surface", "surfaceshader", [(name, type_, link)])}
        if port.type == "material":
            return "tried"
        if port.type == "surfaceshader":
            return self.material(writer, how)
        if port.type == "displacementshader":
            return self.material(writer, {"nodename": writer.closure("surfaceshader", 0)}, displacementshader=how)
        if port.type == "volumeshader":
            return writer.node("volumematerial", "material", [("volumeshader", "volumeshader", how)], name="shown")
        if port.type == "VDF":
            top = writer.node("dielectric_bsdf", "BSDF", [("scatter_mode", "string", {"value": "T"}), ("roughness", "vector2", {"value": "0.1, 0.1"})])
            layered = writer.node("layer", "BSDF", [("top", "BSDF", {"nodename": top}), ("base", "VDF", how)])
            return self.material(writer, surface("bsdf", "BSDF", {"nodename": layered}))
        if port.type in ("BSDF", "EDF"):
            return self.material(writer, surface(port.type.lower(), port.type, how))
        type_ = port.type
        if type_ in ("matrix33", "matrix44"):
            vector = "vector3" if type_ == "matrix33" else "vector4"
            seen = writer.node("transformmatrix", vector, [("in", vector, writer.varied(vector, 3, 0.2, 0.9)), ("mat", type_, how)])
            how, type_ = {"nodename": seen}, vector
        elif type_ in ("string", "filename"):
            reads = [("file", "filename", how if type_ == "filename" else {"value": "grid.png"})]
            if type_ == "string":
                reads.append(("uaddressmode", "string", how))
            how, type_ = {"nodename": writer.node("image", "color3", reads)}, "color3"
        name = "shown_" + port.name
        link = "".join(f" {k}={quoteattr(v)}" for k, v in how.items())
        writer.lines.append(f'  <output name="{name}" type="{type_}"{link}/>')
        return name


def cases(signature):
    """All cases of a signature."""
    maker = Maker(signature)
    all_ = [Case(signature, "default", maker.build("default"))]
    if not signature.inputs:
        return all_
    seen = {all_[0].text}
    plans = [("written", "written", None), ("varied", "varied", None)]
    if signature.is_closure:
        plans += [(g, g, None) for g in GROUPS if any(group_of(p) == g for p in signature.inputs)]
    else:
        plans.append(("signed", "signed", None))
    plans += [(f"{p.name}={c}", "varied", (p.name, c)) for p in signature.inputs for c in p.choices if c != p.value]
    for name, how, choice in plans:
        built = maker.build(how, choice)
        if built[0] not in seen:
            seen.add(built[0])
            all_.append(Case(signature, name, built))
    return all_
