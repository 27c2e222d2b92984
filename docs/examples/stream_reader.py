"""Packed frames, read as the page about the stream says: stream_reader.py [URL]."""

import json
import sys
import urllib.request
import zlib

import numpy as np
from websockets.sync.client import connect


def read_packed(data, last):
    """Return tick, flags and steps of 20 µm from rest, shape (vertices, 3).

    `last` is what the frame before was read as. None where this one is told by another.
    """
    flags, tick = int.from_bytes(data[2:4], "little"), int.from_bytes(data[4:8], "little")
    vertices, back = (int(number) for number in np.frombuffer(data, "<u2", 2, 64))
    planes = zlib.decompress(data[76 if flags & 2 else 68 :], -15)
    low, high = np.frombuffer(planes, np.uint8).reshape(2, 3, vertices).astype(np.uint16)
    signless = low + 256 * high
    differences = (signless >> 1) ^ (0 - (signless & 1))
    steps = np.cumsum(differences, axis=1, dtype=np.uint16).view(np.int16).T
    if back == 0:
        return tick, flags, steps
    if last is None or last[0] != (tick - back) % 2**32:
        return None  # A whole frame comes within a second.
    return tick, flags, last[2] + steps


url = sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8000"
request = urllib.request.Request(url + "/api/sessions", b"{}", {"Content-Type": "application/json"})
stream = json.load(urllib.request.urlopen(request))["stream"] + "?frames=packed"
with connect(url.replace("http", "ws", 1) + stream, subprotocols=["risorius.v1"]) as socket:
    socket.send(json.dumps({"type": "controls", "action_units": {"AU12": 1}, "fade": 0.3}))
    frame, most = None, 0.0
    while not (most and frame[1] & 1):  # Until it has moved and sleeps again.
        message = socket.recv()
        if isinstance(message, bytes) and message[:2] == bytes((2, 1)):
            frame = read_packed(message, frame) or frame
            most = 0.02 * float(np.abs(frame[2]).max())
            print(f"tick {frame[0]}: {len(message)} bytes, up to {most:.2f} mm")
