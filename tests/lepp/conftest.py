import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # the twins of the kernels are modules here
