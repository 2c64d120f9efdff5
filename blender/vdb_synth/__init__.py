"""vdb_synth in Blender: new geometry from examples, on the selected object. docs/blender.md shows how."""
bl_info = {
    "name": "vdb_synth",
    "author": "the vdb_synth team",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > vdb_synth",
    "description": "New geometry from examples: synthesis, analogies, patches, colours and relief",
    "category": "Mesh",
}

import bpy

from . import methods, operators


def property_of(choice):
    if choice.kind == "flag":
        return bpy.props.BoolProperty(name=choice.name.replace("-", " "), description=choice.says, default=choice.default)
    if choice.kind == "whole":
        return bpy.props.IntProperty(name=choice.name.replace("-", " "), description=choice.says, default=choice.default, min=choice.low, max=choice.high)
    if choice.kind == "real":
        return bpy.props.FloatProperty(name=choice.name.replace("-", " "), description=choice.says, default=choice.default, min=choice.low, max=choice.high)
    if choice.kind == "choice":
        items = [(word or "AUTO", word or "automatic", choice.says) for word in choice.choices]
        return bpy.props.EnumProperty(name=choice.name.replace("-", " "), description=choice.says, items=items)
    return bpy.props.StringProperty(name=choice.name.replace("-", " "), description=choice.says, default=choice.default)


def settings_class(one):
    """A group of properties with everything that a method's panel shows."""
    annotations = {
        "seed": bpy.props.IntProperty(name="seed", description="another seed gives another result, the same seed the same one", default=0, min=0),
        "as_volume": bpy.props.BoolProperty(name="as volume", description="the result is a volume of a .vdb file instead of a mesh", default=False),
        "hide_source": bpy.props.BoolProperty(name="hide the source", description="hides the selected object, where the result takes its place",
                                              default=one.command in {"analogy", "texture", "relief"}),
        "progress": bpy.props.FloatProperty(default=0.0, min=0.0, max=1.0, subtype="FACTOR"),
        "stage": bpy.props.StringProperty(default=""),
    }
    for role in one.others:
        if role != "image":
            annotations[role + "_object"] = bpy.props.PointerProperty(type=bpy.types.Object, name=role)
        annotations[role + "_file"] = bpy.props.StringProperty(name=role + " file", subtype="FILE_PATH")
    for choice in one.options:
        annotations[choice.key] = property_of(choice)
    return type("VDBSYNTH_PG_" + one.command, (bpy.types.PropertyGroup,), {"__annotations__": annotations})


def panel_class(one):
    def draw(self, context):
        layout, settings = self.layout, operators.settings_of(context.scene, one)
        for role in one.others:
            if role != "image":
                layout.prop(settings, role + "_object")
            if role == "image" or getattr(settings, role + "_object") is None:
                layout.prop(settings, role + "_file")
        for choice in one.options:
            layout.prop(settings, choice.key)
        if one.result == "model":
            layout.prop(settings, "seed")
            row = layout.row()
            row.prop(settings, "as_volume")
            row.prop(settings, "hide_source")
        if one.command in operators.running:
            layout.prop(settings, "progress", text=settings.stage or "starting", slider=True)
            layout.operator("vdb_synth.cancel").command = one.command
        else:
            layout.operator("vdb_synth.run", text=one.label).command = one.command

    return type("VDBSYNTH_PT_" + one.command, (bpy.types.Panel,), {
        "bl_idname": "VDBSYNTH_PT_" + one.command, "bl_label": one.label, "bl_space_type": "VIEW_3D", "bl_region_type": "UI",
        "bl_category": "vdb_synth", "bl_options": set() if one.command == "synth" else {"DEFAULT_CLOSED"}, "draw": draw})


class VDBSYNTH_PT_result(bpy.types.Panel):
    bl_idname = "VDBSYNTH_PT_result"
    bl_label = "Result"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "vdb_synth"

    @classmethod
    def poll(cls, context):
        return operators.VDBSYNTH_OT_settings.poll(context)

    def draw(self, context):
        self.layout.operator("vdb_synth.settings")


class VDBSYNTH_AP_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(name="vdb_synth", description="path of the program; empty: the one on PATH", subtype="FILE_PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


SETTINGS = {one.command: settings_class(one) for one in methods.METHODS}
CLASSES = (VDBSYNTH_AP_preferences, *operators.CLASSES, *SETTINGS.values(), VDBSYNTH_PT_result, *(panel_class(one) for one in methods.METHODS))


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    for command, group in SETTINGS.items():
        setattr(bpy.types.Scene, "vdb_synth_" + command, bpy.props.PointerProperty(type=group))


def unregister():
    for job in list(operators.running.values()):
        job.cancel()
    for command in SETTINGS:
        delattr(bpy.types.Scene, "vdb_synth_" + command)
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
