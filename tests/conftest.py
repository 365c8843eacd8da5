"""Settings that all tests share."""

from hypothesis import settings

# The same examples in every run and no time limit per example: the suite must not fail by chance or on a slow machine.
# Long random campaigns are in benchmarks/.
settings.register_profile("deltacam", deadline=None, derandomize=True)
settings.load_profile("deltacam")
