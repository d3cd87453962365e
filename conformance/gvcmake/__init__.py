# SPDX-License-Identifier: MIT
"""A writer of .gvc files made from spec/gvc.md alone, which can break each of its rules one at a time."""
