# SPDX-License-Identifier: MIT
"""Requirements of the specification, and which vectors try them."""
