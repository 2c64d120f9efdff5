"""What a Python Processor TOP does with a job file of `vdb_synth batch`: one work item a job, with the same order and files. Houdini hands over all
objects; no module of Houdini is imported.

In the node's onGenerate callback, with a spare string parameter `jobs`:

    from vdbsynth_houdini import tops
    tops.generate(item_holder, self["jobs"].evaluateString())
    return pdg.result.Success

In its onAddInternalDependencies callback:

    from vdbsynth_houdini import tops
    tops.add_dependencies(dependency_holder, internal_items)
    return pdg.result.Success
"""
from . import batches

STEP, AFTER = "vdbsynth_step", "vdbsynth_after"


def generate(item_holder, jobs, program=""):
    folder, steps = batches.plan(jobs, program)
    for index, step in enumerate(steps):
        item = item_holder.addWorkItem(name=step.name, index=index)
        item.setCommand(batches.shell_line(step, folder))
        item.setStringAttrib(STEP, step.name)
        item.setStringAttrib(AFTER, " ".join(step.after))
        for path in step.writes:
            item.addExpectedOutputFile(path, "file/geo", True)


def add_dependencies(dependency_holder, internal_items):
    by_name = {item.stringAttribValue(STEP): item for item in internal_items}
    for item in internal_items:
        for name in item.stringAttribValue(AFTER).split():
            dependency_holder.addDependency(item, by_name[name])
