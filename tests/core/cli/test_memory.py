import subprocess
import sys

import pytest

FAULTS = """
import resource
import numpy as np
from silhouette_mocap.core.cli.memory import keep_freed_memory
if {kept}:
    keep_freed_memory()
def filled():
    for _ in range(10):
        held = [np.ones(250_000) for _ in range(8)]
filled()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
filled()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="glibc alone has these options")
def test_memory_that_is_freed_is_used_again_without_new_pages():
    faults = [
        int(subprocess.check_output([sys.executable, "-c", FAULTS.format(kept=kept)]))
        for kept in (False, True)
    ]
    assert faults[0] > 1_000
    assert faults[1] < 0.1 * faults[0]
