"""Compiling kernels: their options, where machine code is kept, memory to work in."""

from lepp.jit.options import inlined, kernel

__all__ = ["inlined", "kernel"]
