"""The commands in tools/ can be imported, behind the standard library: one has a name of its."""

import sys
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent / "tools"
sys.path += [str(TOOLS), str(TOOLS / "docs")]
