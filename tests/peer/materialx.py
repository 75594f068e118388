"""MaterialX's own GLSL generator, in this process: a peer to compare with, never a dependency. Needs PyPI's materialx."""
import pathlib

import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as mx_glsl
import MaterialX.PyMaterialXGenShader as mx_gen


class Peer:
    """Generates with the values of a document in the code, as its `reduced` interface does; distances in metres."""

    version = mx.getVersionString()

    def __init__(self):
        self.path = mx.getDefaultDataSearchPath()
        self.library = mx.createDocument()
        mx.loadLibraries(mx.getDefaultDataLibraryFolders(), self.path, self.library)
        self.generator = mx_glsl.GlslShaderGenerator.create()
        self.context = mx_gen.GenContext(self.generator)
        self.context.registerSourceCodeSearchPath(self.path)
        self._colours()
        self._units()
        options = self.context.getOptions()
        options.targetDistanceUnit = "meter"
        options.targetColorSpaceOverride = "lin_rec709"
        options.shaderInterfaceType = mx_gen.ShaderInterfaceType.SHADER_INTERFACE_REDUCED

    def _colours(self):
        system = mx_gen.DefaultColorManagementSystem.create(self.generator.getTarget())
        system.loadLibrary(self.library)
        self.generator.setColorManagementSystem(system)

    def _units(self):
        registry = mx.UnitConverterRegistry.create()
        for unit in ("distance", "angle"):
            definition = self.library.getUnitTypeDef(unit)
            registry.addUnitConverter(definition, mx.LinearUnitConverter.create(definition))
        system = mx_gen.UnitSystem.create(self.generator.getTarget())
        system.loadLibrary(self.library)
        system.setUnitConverterRegistry(registry)
        self.generator.setUnitSystem(system)

    def read(self, text):
        document = mx.createDocument()
        mx.readFromXmlString(document, text, mx.FileSearchPath())
        document.setDataLibrary(self.library)
        return document

    def read_file(self, file):
        document = mx.createDocument()
        mx.readFromXmlFile(document, str(file), mx.FileSearchPath(str(pathlib.Path(file).parent)))
        document.setDataLibrary(self.library)
        return document

    def renderable(self, document):
        """The elements that it calls renderable, by path."""
        return [e.getNamePath() for e in mx_gen.findRenderableElements(document)]

    def generate(self, document, path, stem):
        """Writes stem.vert and stem.frag; returns "" or why it cannot."""
        element = document.getDescendant(path)
        if element is None:
            return f"there is no element {path}"
        try:
            shader = self.generator.generate("peer", element, self.context)
        except Exception as error:  # whatever it throws is its answer
            return str(error) or "it fails without a word"
        for stage, ending in (("vertex", ".vert"), ("pixel", ".frag")):
            pathlib.Path(str(stem) + ending).write_text(shader.getSourceCode(stage))
        return ""
