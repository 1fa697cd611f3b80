"""Designs: which triangulations a study is made of, and how their points are drawn."""
