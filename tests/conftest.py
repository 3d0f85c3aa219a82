"""Settings of every test."""

import os

# The tests run in one process a core: threads of NumPy's own would only stand in each other's way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import settings

# The same examples each time, and no limit of time: machines differ, and are busy.
settings.register_profile("here", derandomize=True, deadline=None)
settings.load_profile("here")
