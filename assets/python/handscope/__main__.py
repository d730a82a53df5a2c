"""`python -m handscope` is the program of this package."""

import subprocess
import sys

from .program import find

sys.exit(subprocess.call([find(), *sys.argv[1:]]))
