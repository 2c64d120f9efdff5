"""The digital assets as text, in the expanded form that Houdini installs from an otls folder. Plain Python.

    python3 -m vdbsynth_houdini.assets OTLS     writes OTLS/vdbsynth_COMMAND.hda/ for each method

Assets of the kind "Python operator" have no nodes inside, so everything about them is text.
"""
import os
import sys

from . import methods

PROPERTIES = {"CheckExternal": 1, "ContentsCompressionType": 1, "ForbidOutsideParms": 1, "GzipContents": 1, "LockContents": 1, "MakeDefault": 1,
              "ParmsFromVfl": 0, "PrefixDroppedParmLabel": 0, "PrefixDroppedParmName": 0, "SaveCachedCode": 0, "SaveIcon": 1, "SaveSpareParms": 0,
              "UnlockOnCreate": 0, "UseDSParms": 1}
CACHE = "$HOUDINI_TEMP_DIR/vdb_synth"


def code(one):
    """The PythonCook section, and the script of a Python SOP inside a subnet."""
    return f"import hou\nfrom vdbsynth_houdini import cook\n\ncook.cook(hou.pwd(), {one.command!r})\n"


def text(value):
    return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'


def parameter(name, label, kind, default, says, low=None, high=None, choices=()):
    if choices:
        default = [token for token, _ in choices].index(default)  # dialog scripts count a menu's entries
    lines = [f"name    {text(name)}", f"label   {text(label)}", f"type    {kind}", f"default {{ {text(default)} }}"]
    if says:
        lines.append(f"help    {text(says)}")
    if choices:
        lines.append("menu {\n" + "".join(f"            {text(token)} {text(shown)}\n" for token, shown in choices) + "        }")
    if low is not None:
        lines.append(f"range   {{ {low} {high} }}")
    return "    parm {\n" + "".join(f"        {line}\n" for line in lines) + "    }\n"


KINDS = {"real": "float", "whole": "integer", "text": "string", "file": "file", "flag": "toggle", "choice": "ordinal"}


def parameters(one):
    """(name, label, kind, default, says, low, high, choices) of all parameters of an asset, in Houdini's kinds."""
    rows = []
    if len(one.results) > 1:
        rows.append(("vdbsynth_result", "Result", "ordinal", one.results[0], "what comes out", None, None,
                     [("vdb", "VDB"), ("mesh", "Polygons")]))
    else:
        rows.append(("vdbsynth_result", "Result", "ordinal", one.results[0], "what comes out", None, None,
                     [(one.results[0], {"mesh": "Polygons", "report": "Report"}[one.results[0]])]))
    for role in one.roles:
        rows.append((role.parm, role.label + " File", "file", "", role.says + (", where no SOP is connected" if role.wired else ""), None, None, ()))
    for option in one.options:
        default = int(option.default) if option.kind == "flag" else option.default
        choices = [(choice or methods.AUTOMATIC, choice or methods.AUTOMATIC) for choice in option.choices]
        default = default or methods.AUTOMATIC if choices else default
        rows.append((option.parm, option.label, KINDS[option.kind], default, option.says, option.low, option.high, choices))
    rows.append(("vdbsynth_program", "Program", "file", "", "path of vdb_synth; empty: VDB_SYNTH of the environment, else PATH", None, None, ()))
    rows.append(("vdbsynth_cache", "Cache", "file", CACHE, "folder of results; a run with equal inputs and options is not repeated", None, None, ()))
    rows.append(("vdbsynth_cache_size", "Cache Size", "float", 10.0, "most that the folder may hold (GiB); what was used longest ago goes first",
                 0, 100, ()))
    return rows


def dialog_script(one):
    lines = [f"# Dialog script for {one.type_name}\n\n{{\n    name    {one.type_name}\n    script  {one.type_name}\n    label   {text(one.label)}\n\n"
             f"    help {{\n        {text(one.says)}\n    }}\n\n"]
    lines += [f"    inputlabel {index + 1} {text(role.label)}\n" for index, role in enumerate(one.wired)]
    lines.append("\n")
    lines += [parameter(*row) for row in parameters(one)]
    return "".join(lines) + "}\n"


def help_text(one):
    rows = [f"= {one.label} =\n\n\"\"\"{one.says}\"\"\"\n\nRuns `vdb_synth {one.command}`.\n\n@inputs\n\n"]
    rows += [f"{role.label}:\n    {role.says}\n\n" for role in one.roles]
    rows.append("@parameters\n\n")
    rows += [f"{row[1]}:\n    {row[4]}\n\n" for row in parameters(one)]
    return "".join(rows)


def shelf(one):
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<shelfDocument>
  <tool name="$HDA_DEFAULT_TOOL" label="$HDA_LABEL" icon="$HDA_ICON">
    <toolMenuContext name="viewer"><contextNetType>SOP</contextNetType></toolMenuContext>
    <toolMenuContext name="network"><contextOpType>$HDA_TABLE_AND_NAME</contextOpType></toolMenuContext>
    <toolSubmenu>VDB Synth</toolSubmenu>
    <script scriptType="python"><![CDATA[import soptoolutils

soptoolutils.genericTool(kwargs, '$HDA_NAME')]]></script>
  </tool>
</shelfDocument>
"""


def section_file(name):
    """As the expanded form spells names of sections and types."""
    return name.replace("_", "__").replace("/", "_1").replace(":", "_8")


def files(one):
    """{path: text} below the asset's folder."""
    operator = f"vdbsynth::Sop/{one.command}::1.0"
    inner = section_file(operator)
    fewest = 0  # files may stand in for any input
    sections = {"DialogScript": dialog_script(one), "TypePropertiesOptions": "".join(f"{key} := {value};\n" for key, value in PROPERTIES.items()),
                "Help": help_text(one), "Tools.shelf": shelf(one), "PythonCook": code(one),
                "ExtraFileOptions": '{\n\t"PythonCook/IsPython":{\n\t\t"type":"bool",\n\t\t"value":true\n\t}\n}\n'}
    index = "".join(f"{key + ':':<14}{value}\n" for key, value in [
        ("Operator", one.type_name), ("Label", one.label), ("Path", f"oplib:/{operator}?{operator}"), ("Icon", "SOP_vdb"), ("Table", "Sop"),
        ("License", ""), ("Extra", ""), ("User", ""), ("Inputs", f"{fewest} to {len(one.wired)}"), ("Subnet", "false"), ("Python", "true"),
        ("Empty", "false"), ("Modified", "Fri Nov 27 00:00:00 2026")])
    found = {"INDEX__SECTION": index + "\n", "houdini.hdalibrary": "",
             "Sections.list": f'""\nINDEX__SECTION\tINDEX_SECTION\nhoudini.hdalibrary\thoudini.hdalibrary\n{inner}\t{operator}\n',
             f"{inner}/Sections.list": '""\n' + "".join(f"{section_file(name)}\t{name}\n" for name in sections)}
    found.update({f"{inner}/{section_file(name)}": content for name, content in sections.items()})
    return found


def write(folder):
    for one in methods.METHODS:
        for path, content in files(one).items():
            path = os.path.join(folder, f"vdbsynth_{one.command}.hda", path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w") as file:
                file.write(content)


if __name__ == "__main__":
    write(sys.argv[1])
