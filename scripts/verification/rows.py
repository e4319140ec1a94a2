"""The rows of an accuracy report, which report.py writes: a line of JSON each."""

import json
import os


def append_rows(rows):
    """Adds what was measured to the report that is being made, if one is."""
    if "WAVELOBE_VERIFY_ROWS" in os.environ:
        with open(os.environ["WAVELOBE_VERIFY_ROWS"], "a", encoding="utf-8") as out:
            out.writelines(json.dumps(row) + "\n" for row in rows)
