# SPDX-License-Identifier: MIT
"""Runs a decoder on the vectors of the conformance set and judges it."""
