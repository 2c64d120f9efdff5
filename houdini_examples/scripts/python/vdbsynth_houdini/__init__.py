"""Runs vdb_synth from Houdini. Only cook.py and tops.py touch Houdini's modules; the rest is plain Python and runs anywhere.

methods.py   what the assets offer: inputs, options, results
runs.py      one run of the program: cache by content, progress, cancel
assets.py    the expanded digital assets in otls/, as text made of methods.py
batches.py   job files and plans of `vdb_synth batch`
cook.py      what a SOP does when it cooks (hou)
tops.py      what a Python Processor TOP does (pdg)
"""
import os
import sys


def _find_shared_modules():
    """vdbsynth_tool and vdbsynth_ply lie beside this package when it is installed, in python/ of the source tree otherwise."""
    here = os.path.dirname(os.path.abspath(__file__))
    for folder in (os.path.dirname(here), os.path.join(here, "..", "..", "..", "..", "python")):
        if os.path.isfile(os.path.join(folder, "vdbsynth_tool.py")):
            if folder not in sys.path:
                sys.path.append(os.path.abspath(folder))
            return


_find_shared_modules()
