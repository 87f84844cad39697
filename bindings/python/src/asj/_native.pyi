# SPDX-License-Identifier: BSD-2-Clause
"""The library as cffi sees it; generate_native.py makes it from the public headers."""

from typing import Any

ffi: Any
lib: Any
