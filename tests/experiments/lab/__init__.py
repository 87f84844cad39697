# SPDX-License-Identifier: BSD-2-Clause
"""The experiments' modules: what they measure stands in criteria.py, scale.py and score.py, each experiment in parts/."""
