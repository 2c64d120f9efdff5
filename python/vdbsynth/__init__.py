"""New geometry from examples: the methods of vdb_synth on level sets in memory. docs/python.md begins with an example."""
try:
    from . import _vdbsynth
except ImportError as error:
    raise ImportError(
        "vdbsynth: its compiled module is not beside this file; build with -DVDBSYNTH_PYTHON=ON and import it from "
        f"build/release/python ({error})") from error

from ._vdbsynth import *  # noqa: F401,F403

__version__ = _vdbsynth.__version__
__all__ = [name for name in dir(_vdbsynth) if not name.startswith("_")]
