"""Makes .hda files. Run by Houdini's Python:

    hython build_assets.py OUT              builds each asset from the table of methods, by Houdini's own calls
    hython build_assets.py OUT --collapse   packs the text in otls/ instead

The first way does not depend on the text form: Houdini writes everything. Each asset is a subnet with a Python SOP in it.
"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "scripts", "python"))

import hou
from vdbsynth_houdini import assets, methods


def template(name, label, kind, default, says, low, high, choices):
    """A parameter for Houdini."""
    if kind == "ordinal":
        tokens, shown = zip(*choices)
        return hou.MenuParmTemplate(name, label, tokens, menu_labels=shown, default_value=tokens.index(default), help=says)
    if kind == "toggle":
        return hou.ToggleParmTemplate(name, label, default_value=bool(default), help=says)
    if kind == "integer":
        return hou.IntParmTemplate(name, label, 1, default_value=(default,), min=low, max=high, help=says)
    if kind == "float":
        return hou.FloatParmTemplate(name, label, 1, default_value=(default,), min=low, max=high, help=says)
    string = hou.stringParmType.FileReference if kind == "file" else hou.stringParmType.Regular
    return hou.StringParmTemplate(name, label, 1, default_value=(default,), string_type=string, help=says)


def build(one, path):
    geometry = hou.node("/obj").createNode("geo")
    try:
        subnet = geometry.createNode("subnet", one.command)
        python = subnet.createNode("python", "cook")
        python.parm("python").set(assets.code(one))
        for index in range(len(one.wired)):
            python.setInput(index, subnet.indirectInputs()[index])
        python.setDisplayFlag(True)
        python.setRenderFlag(True)
        asset = subnet.createDigitalAsset(name=one.type_name, hda_file_name=path, description=one.label, min_num_inputs=0,
                                          max_num_inputs=len(one.wired))
        definition = asset.type().definition()
        definition.setParmTemplateGroup(hou.ParmTemplateGroup([template(*row) for row in assets.parameters(one)]))
        definition.addSection("Help", assets.help_text(one))
        definition.addSection("Tools.shelf", assets.shelf(one))
    finally:
        geometry.destroy()


def main(arguments):
    folder = os.path.abspath(arguments[0])
    os.makedirs(folder, exist_ok=True)
    for one in methods.METHODS:
        path = os.path.join(folder, f"vdbsynth_{one.command}.hda")
        if "--collapse" in arguments[1:]:
            hou.hda.collapseFromDirectory(path, os.path.join(HERE, "otls", f"vdbsynth_{one.command}.hda"))
        else:
            build(one, path)
        names = [definition.nodeTypeName() for definition in hou.hda.definitionsInFile(path)]
        if names != [one.type_name]:
            raise SystemExit(f"{path}: holds {names}, not {one.type_name}")
        print(path)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    main(sys.argv[1:])
