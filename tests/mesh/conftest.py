import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # the meshes are a module here
sys.path.insert(0, str(Path(__file__).parents[1] / "lepp"))  # and so are the twins of the kernels
