"""What the assets offer: the methods, their inputs and the options that are used most. Plain Python, without hou."""

AUTOMATIC = "automatic"  # the token of a menu for the program's own choice: tokens must not be empty


class Option:
    """One option of the program. kind: real, whole, text, file, flag or choice; "" or 0 as the default leaves the choice to the program."""

    def __init__(self, name, kind, default, label, says, low=None, high=None, choices=()):
        self.name, self.kind, self.default, self.label, self.says = name, kind, default, label, says
        self.low, self.high, self.choices = low, high, choices

    @property
    def parm(self):
        """The name of Houdini's parameter: dashes are not allowed there."""
        return self.name.replace("-", "_")


class Role:
    """One input. Wired SOPs go before the file parameter; `wired` False means that only a file will do, as for images."""

    def __init__(self, name, label, says, wired=True):
        self.name, self.label, self.says, self.wired = name, label, says, wired

    @property
    def parm(self):
        return self.name + "_file"


class Method:
    """`roles` are in the order of Houdini's inputs, with what is changed first; `order` is theirs on the command line."""

    def __init__(self, command, label, says, roles, order, options, results=("vdb", "mesh"), mesh="ply"):
        self.command, self.label, self.says, self.roles, self.order = command, label, says, roles, order
        self.options, self.results, self.mesh = options, results, mesh

    @property
    def type_name(self):
        return f"vdbsynth::{self.command}::1.0"

    @property
    def wired(self):
        return [role for role in self.roles if role.wired]

    def extension(self, result):
        """Of the file that holds the result."""
        if result not in self.results:
            raise ValueError(f"{self.command}: result {result!r} is none of {', '.join(self.results)}")
        return {"vdb": "vdb", "mesh": self.mesh, "report": "json"}[result]


TARGET = Role("target", "Model", "polygons or a level set")
SEED = Option("seed", "whole", 0, "Seed", "of everything random; the same seed gives the same result", 0, 1000000)
GRID = Option("grid", "text", "", "Grid", "name of the VDB to take; empty: surface, else the first level set")
ISO = Option("iso", "real", 0.0, "Iso Value", "a fog volume, such as density, is solid above this value; 0: not given", 0.0, 10.0)
RESOLUTION = Option("resolution", "whole", 128, "Resolution", "voxels along the longest side of polygons; VDBs keep their voxels", 8, 2000)
EXEMPLAR_RESOLUTION = Option("exemplar-resolution", "whole", 0, "Exemplar Resolution",
                             "voxels along the longest side of the exemplar's polygons; 0: the program's choice", 0, 2000)
SCALE = Option("scale", "real", 1.0, "Scale", "size of the texture", 0.25, 4.0)
DIRECTION = Option("direction", "text", "", "Direction", "axis:y, around:y, radial, curvature or FILE.vdb:GRID; empty: the program's choice")
DRAFT = Option("draft", "flag", False, "Draft", "a quick look")
MASK = Option("mask", "file", "", "Mask", "where to work: a grid of weights from 0 to 1, or the inside of a model")

METHODS = [
    Method("synth", "VDB Synth More", "Makes a larger piece of a texture, or more of an object.",
           [Role("exemplar", "Exemplar", "what to make more of: polygons or a level set")], ["exemplar"], [
               Option("size", "text", "2x,2x,1x", "Size", "multiples such as 2x, or voxels, along x, y and z"), RESOLUTION,
               Option("block", "whole", 0, "Block", "side of the matched blocks (voxels); 0: the program's choice", 0, 256),
               Option("border", "choice", "", "Border", "how the result ends along axes that grow", choices=("", "cut", "object", "tile")),
               DRAFT, GRID, ISO, SEED]),
    Method("analogy", "VDB Synth Analogy", "Gives a model the texture that one model has and its plain twin has not.",
           [TARGET, Role("plain", "Plain Example", "A"), Role("textured", "Textured Example", "A2, aligned with A")],
           ["plain", "textured", "target"], [
               RESOLUTION, EXEMPLAR_RESOLUTION, DIRECTION, SCALE,
               Option("strength", "real", 1.0, "Strength", "blend from the model to the result", 0.0, 1.0), MASK, GRID, ISO, SEED]),
    Method("patch", "VDB Synth Patch", "Makes a larger sheet of a geometry texture, patch by patch.",
           [Role("exemplar", "Exemplar", "a sheet: points, polygons or a level set")], ["exemplar"], [
               Option("size", "text", "2x,2x", "Size", "multiples such as 2x, or lengths (world)"),
               Option("plane", "choice", "", "Plane", "plane of the sheet; Houdini's ground is zx", choices=("", "xy", "yz", "zx")),
               Option("patch", "real", 0.0, "Patch Size", "side of a patch (world); 0: the program's choice", 0.0, 100.0),
               Option("voxel-size", "real", 0.0, "Voxel Size", "of the result (world); 0: the program's choice", 0.0, 10.0),
               Option("tile", "flag", False, "Tile", "the sheet continues at its opposite sides"), DRAFT, GRID, ISO, SEED], mesh="obj"),
    Method("texture", "VDB Synth Texture", "Colours polygons or points like an image.",
           [TARGET, Role("image", "Image", "what to colour like", wired=False)], ["target", "image"],
           [SCALE, DIRECTION, DRAFT, SEED], results=("mesh",)),
    Method("relief", "VDB Synth Relief", "Takes the relief off a sample, or a picture, and grows it on a model.",
           [TARGET, Role("sample", "Sample", "a model with relief, or a picture")], ["sample", "target"], [
               RESOLUTION, EXEMPLAR_RESOLUTION, DIRECTION,
               Option("scale", "real", 1.0, "Scale", "size of the relief", 0.05, 20.0),
               Option("strength", "real", 1.0, "Strength", "height of the relief; below 0 inverted", -10.0, 10.0),
               MASK, DRAFT, GRID, ISO, SEED]),
    Method("compare", "VDB Synth Compare", "Measures a model beside a reference; the numbers become a detail attribute.",
           [Role("other", "Model", "what to judge"), Role("reference", "Reference", "what to compare with")], ["reference", "other"],
           [RESOLUTION, GRID, ISO], results=("report",)),
]


def method(command):
    for one in METHODS:
        if one.command == command:
            return one
    raise KeyError(command)


def options_of(one, values, extensions=()):
    """The options of the command line from {parm: value}. Defaults that stand for the program's own choice are left out. `extensions` of the inputs, in
    the command line's order, leave out what would resample a VDB. Raises ValueError for values that the asset does not know."""
    unknown = set(values) - {option.parm for option in one.options}
    if unknown:
        raise ValueError(f"{one.command}: unknown parameter {', '.join(sorted(unknown))}")
    options = {}
    for option in one.options:
        value = values.get(option.parm, option.default)
        if option.kind == "flag":
            if value:
                options[option.name] = True
        elif option.name == "seed" or value not in ("", AUTOMATIC, 0, 0.0, None):
            options[option.name] = round(value, 9) if option.kind == "real" else value
    resampled = {"compare": extensions[:1]}.get(one.command, extensions[-1:])
    if "vdb" in resampled:
        options.pop("resolution", None)
    if one.command == "texture":
        options["as"] = "mesh"
    return options
