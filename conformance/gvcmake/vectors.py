# SPDX-License-Identifier: MIT
"""All vectors."""
from . import good_surfaces
from .suite import Suite

PARTS = (good_surfaces,)


def everything(folder):
    """The whole suite; folder: that of the conformance set."""
    suite = Suite()
    for part in PARTS:
        part.everything(suite)
    return suite
