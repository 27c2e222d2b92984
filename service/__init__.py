"""Risorius service: sessions of the simulator over HTTP and WebSocket."""
