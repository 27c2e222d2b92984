"""Risorius service: sessions of the simulator over HTTP and WebSocket."""

import os

# Matrix products have one thread, here and in the processes that are started: beside live faces
# several mostly wait for each other, which took a clip 13 times the processor, and how many there
# are shows in the last bits of a file. These are read once, when NumPy is first imported.
for _variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"):
    os.environ.setdefault(_variable, "1")
