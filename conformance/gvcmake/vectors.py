# SPDX-License-Identifier: MIT
"""All vectors."""
from . import (bad_config, bad_exact, bad_file, bad_fragments, bad_head, bad_records, bad_streams, bad_tables, good_container,
               good_exact, good_records, good_streams, good_surfaces, recorded)
from .suite import Suite

PARTS = (good_surfaces, good_container, good_streams, good_records, good_exact, bad_head, bad_file, bad_fragments, bad_config,
         bad_records, bad_tables, bad_streams, bad_exact)


def everything(folder):
    """The whole suite; folder: that of the conformance set."""
    suite = Suite()
    for part in PARTS:
        part.everything(suite)
    recorded.everything(suite, folder)
    return suite
