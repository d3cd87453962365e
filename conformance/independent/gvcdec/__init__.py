# SPDX-License-Identifier: MIT
"""Independent decoder of gvc files, written from gvc.md alone."""
