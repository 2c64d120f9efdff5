"""The operators: one for all methods. A timer looks after the program's process, so Blender can be used meanwhile."""
import json
import os
import shutil
import tempfile

import bpy

from . import exchange, methods
from .vdbsynth_tool import Job, ToolError

running = {}  # the jobs under way, one a method


def preferences():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def program():
    own = preferences()
    return own.program if own else ""


def settings_of(scene, one):
    return getattr(scene, "vdb_synth_" + one.command)


def values_of(settings, one):
    return {choice.key: getattr(settings, choice.key) for choice in one.options}


def input_path(context, settings, one, role, target, folder):
    """A file for one input: the selected object, else the picked object, else the picked file."""
    if role == "object":
        return exchange.export_object(context, target, folder, "selected", one.mesh)
    picked = getattr(settings, role + "_object", None)
    if picked is not None:
        return exchange.export_object(context, picked, folder, role, one.mesh)
    path = bpy.path.abspath(getattr(settings, role + "_file"))
    if not path:
        raise ValueError(f"{one.label}: choose {role.replace('_', ' ')}, an object or a file")
    if not os.path.isfile(path):
        raise ValueError(f"{path}: is not there")
    return path


class VDBSYNTH_OT_run(bpy.types.Operator):
    """Runs a method on the selected object in a process of its own; Escape cancels it"""
    bl_idname = "vdb_synth.run"
    bl_label = "Run"
    bl_options = {"REGISTER", "UNDO"}

    command: bpy.props.StringProperty(options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return context.active_object is not None

    def begin(self, context):
        """Starts the job; raises ValueError and ToolError."""
        one = methods.method(self.command)
        if one.command in running:
            raise ValueError(f"{one.label}: is running; cancel it first")
        self.settings = settings_of(context.scene, one)
        self.target = context.active_object
        self.folder = tempfile.mkdtemp(prefix="vdb_synth_blender_")
        try:
            inputs = [input_path(context, self.settings, one, role, self.target, self.folder) for role in one.inputs]
            values, seed = values_of(self.settings, one), self.settings.seed
            options = methods.options_of(one, values, seed)
            if all(path.endswith(".vdb") for path in inputs[-1:]):
                options.pop("resolution", None)  # a volume has its voxels
            if self.target.type != "VOLUME":
                options.update(one.of_mesh)
            self.result = os.path.join(self.folder, "result." + ("json" if one.result == "report" else "vdb" if self.settings.as_volume else one.mesh))
            if one.result == "report":
                options = {}
            self.job = Job(one.command, inputs, [self.result], options, program(), self.folder)
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise
        self.record = {"command": one.command, "values": values, "seed": seed, "as_volume": self.settings.as_volume,
                       "words": self.job.words[1:], "target": self.target.name}
        running[one.command] = self.job
        self.one = one

    def finish(self, context):
        """Brings the result into the scene; returns Blender's word for how it went."""
        running.pop(self.one.command, None)
        state = self.job.state
        self.settings.progress = 0.0
        self.settings.stage = ""
        try:
            if state.cancelled:
                self.report({"WARNING"}, f"{self.one.label}: cancelled")
                return {"CANCELLED"}
            try:
                self.job.raise_on_error()
            except ToolError as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            for message in state.messages:
                if message.startswith("warning: "):
                    self.report({"WARNING"}, message[len("warning: "):])
            self.bring(context)
            return {"FINISHED"}
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

    def bring(self, context):
        name = f"{self.target.name} {self.one.label.lower()}"
        if self.one.result == "report":
            with open(self.result) as file:
                text = bpy.data.texts.new(name)
                text.write(file.read())
            self.report({"INFO"}, f"the numbers are in the text {text.name}")
            return
        if self.settings.as_volume:
            kept = bpy.path.abspath("//") if bpy.data.filepath else tempfile.gettempdir()
            path = os.path.join(kept, bpy.path.clean_name(name) + ".vdb")
            shutil.move(self.result, path)
            made = exchange.import_volume(path, name)
        else:
            made = exchange.import_mesh(self.result, name)
        made[exchange.SETTINGS] = json.dumps(self.record)
        collection = self.target.users_collection[0] if self.target.users_collection else context.scene.collection
        collection.objects.link(made)
        self.target.select_set(False)
        made.select_set(True)
        context.view_layer.objects.active = made
        if self.settings.hide_source:
            self.target.hide_set(True)

    def execute(self, context):
        """Without a window, as in scripts: to the end."""
        try:
            self.begin(context)
        except (ValueError, ToolError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.job.wait()
        return self.finish(context)

    def invoke(self, context, event):
        try:
            self.begin(context)
        except (ValueError, ToolError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.job.cancel()
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        state = self.job.poll()
        self.settings.progress = state.fraction
        self.settings.stage = state.stage
        for area in context.screen.areas if context.screen else []:
            area.tag_redraw()
        if not state.done:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        return self.finish(context)


class VDBSYNTH_OT_cancel(bpy.types.Operator):
    """Stops the program; nothing half-made is left"""
    bl_idname = "vdb_synth.cancel"
    bl_label = "Cancel"

    command: bpy.props.StringProperty(options={"HIDDEN"})

    def execute(self, context):
        if self.command in running:
            running[self.command].cancel()
        return {"FINISHED"}


class VDBSYNTH_OT_settings(bpy.types.Operator):
    """Takes the settings that the selected result was made with, and selects what it was made of"""
    bl_idname = "vdb_synth.settings"
    bl_label = "Settings of This Result"

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and exchange.SETTINGS in context.active_object

    def execute(self, context):
        record = json.loads(context.active_object[exchange.SETTINGS])
        one = methods.method(record["command"])
        settings = settings_of(context.scene, one)
        for key, value in record["values"].items():
            setattr(settings, key, value)
        settings.seed, settings.as_volume = record["seed"], record["as_volume"]
        source = context.scene.objects.get(record["target"])
        if source is None:
            self.report({"WARNING"}, f"{record['target']}, which it was made of, is no longer in the scene")
            return {"FINISHED"}
        source.hide_set(False)
        context.active_object.select_set(False)
        source.select_set(True)
        context.view_layer.objects.active = source
        return {"FINISHED"}


CLASSES = (VDBSYNTH_OT_run, VDBSYNTH_OT_cancel, VDBSYNTH_OT_settings)
