"""What the panels offer: the methods, their inputs and the options that are used most. Plain Python, without bpy."""


class Choice:
    """One option of the program. kind: real, whole, text, flag or choice; "" or None as the default leaves the option to the program."""

    def __init__(self, name, kind, default, says, low=None, high=None, choices=()):
        self.name, self.kind, self.default, self.says = name, kind, default, says
        self.low, self.high, self.choices = low, high, choices

    @property
    def key(self):
        return self.name.replace("-", "_")


class Method:
    """`others` are the inputs beside the selected object, in the order of the command line; "object" stands for the selected one.
    `mesh` is the kind of file that meshes go and come as: .off, without colours, where the program takes .ply as points.
    `of_mesh` are options that a selected mesh needs."""

    def __init__(self, command, label, says, inputs, options, result="model", mesh="ply", of_mesh=None):
        self.command, self.label, self.says, self.inputs, self.options, self.result = command, label, says, inputs, options, result
        self.mesh, self.of_mesh = mesh, of_mesh or {}

    @property
    def others(self):
        return [name for name in self.inputs if name != "object"]


RESOLUTION = Choice("resolution", "whole", 128, "voxels along the longest side of the selected mesh", 8, 2000)
SCALE = Choice("scale", "real", 1.0, "size of the texture", 0.25, 4.0)
DIRECTION = Choice("direction", "text", "", "direction of the texture: axis:z, around:x, radial, curvature; empty: the program's choice")

METHODS = [
    Method("synth", "More of the Same", "A larger piece of the selected texture, or more of the selected object", ["object"], [
        Choice("size", "text", "2x,2x,1x", "size of the result: multiples such as 2x, or voxels, along x, y and z"),
        RESOLUTION,
        Choice("block", "whole", 0, "side of the matched blocks (voxels); 0: the program's choice", 0, 256),
        Choice("border", "choice", "", "what the result does at its sides", choices=("", "cut", "object", "tile")),
        Choice("draft", "flag", False, "a quick look"),
    ]),
    Method("analogy", "Analogy", "The texture that A2 adds to A, on the selected model", ["plain", "textured", "object"], [
        RESOLUTION, DIRECTION, SCALE,
        Choice("strength", "real", 1.0, "blend from the selected model to the result", 0.0, 1.0),
        Choice("exemplar-resolution", "whole", 0, "voxels along the longest side of A; 0: the program's choice", 0, 2000),
    ]),
    Method("patch", "Patches", "A larger sheet of the selected geometry texture", ["object"], [
        Choice("size", "text", "2x,2x", "size of the sheet: multiples such as 2x, or lengths (world)"),
        Choice("patch", "real", 0.0, "side of a patch (world); 0: the program's choice", 0.0, 1e9),
        Choice("tile", "flag", False, "the sheet continues at its opposite sides"),
        Choice("draft", "flag", False, "a quick look"),
        Choice("voxel-size", "real", 0.0, "voxels of the result (world); 0: the program's choice", 0.0, 1e9),
    ], mesh="off"),
    Method("texture", "Colour by Image", "Colours the selected mesh like an image", ["object", "image"], [
        SCALE, DIRECTION,
        Choice("coherence", "real", 0.0, "preference for sources that continue a neighbour's; 0: the program's choice", 0.0, 100.0),
        Choice("draft", "flag", False, "a quick look"),
    ], of_mesh={"as": "mesh"}),
    Method("relief", "Relief", "Takes the relief off a sample and grows it on the selected model", ["sample", "object"], [
        RESOLUTION, DIRECTION, SCALE,
        Choice("strength", "real", 1.0, "height of the relief, relative to the sample's", 0.0, 10.0),
        Choice("exemplar-resolution", "whole", 0, "voxels along the longest side of the sample; 0: the program's choice", 0, 2000),
    ]),
    Method("compare", "Compare", "Statistics of another model beside the selected one's", ["object", "other"], [], result="report"),
]


def method(command):
    for one in METHODS:
        if one.command == command:
            return one
    raise KeyError(command)


def options_of(one, values, seed):
    """The options of the command line from {key: value}: defaults that stand for the program's own choice are left out."""
    options = {}
    for choice in one.options:
        value = values.get(choice.key, choice.default)
        if choice.kind == "flag":
            if value:
                options[choice.name] = True
        elif value not in ("", "AUTO", 0, 0.0, None):
            options[choice.name] = round(value, 9) if choice.kind == "real" else value
    options["seed"] = seed
    return options
