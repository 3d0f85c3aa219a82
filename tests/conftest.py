"""Settings of every test."""

from hypothesis import settings

# The same examples each time, and no limit of time: machines differ, and are busy.
settings.register_profile("here", derandomize=True, deadline=None)
settings.load_profile("here")
