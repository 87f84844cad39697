# SPDX-License-Identifier: BSD-2-Clause
"""One module for each part of the report: run(session) returns a report.Part."""
