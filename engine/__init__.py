"""Risorius engine: a physically simulated face (Zhang, Prakash, Sung, Eurographics 2001)."""
