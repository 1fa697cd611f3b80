"""Compiling kernels: their options, where machine code is kept, memory to work in."""

from lepp.jit.options import inlined, inner, kernel

__all__ = ["inlined", "inner", "kernel"]
