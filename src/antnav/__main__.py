"""`python -m antnav` is `antnav`."""

from __future__ import annotations

import sys

from antnav_command import main

if __name__ == "__main__":
    sys.exit(main())
