"""The skull side of a face as jaw and lids stand: anchors, bone, normals, and the held nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .arrays import BoolArray, FloatArray, IntArray
from .dynamics import Skull
from .rig import Rig
from .tissue import Lids, TissueModel


def pose_skull(rig: Rig, tissue: TissueModel, jaw: Sequence[float], lids: FloatArray) -> Skull:
    """Return the skull side with the jaw and lids as given.

    The dead load of the pre-tension turns with the jaw too, or the tissue would be pulled askew.
    Nothing travels.

    Args:
        rig: For the hinge and the jaw weights.
        tissue: The rig's tissue.
        jaw: Pitch and yaw, degrees, thrust, mm.
        lids: Angle of left upper, left lower, right upper, right lower lid, degrees, shape (4,).
    """
    n = tissue.node_count
    pitch, yaw, thrust = jaw
    share = rig.head.jaw_weight[:n]
    stacked = np.tile(share, 3)
    targets = rig.jaw.move(tissue.layers.nodes[2 * n :], share, pitch, yaw, thrust)
    targets[tissue.lids.nodes] = turn_lids(tissue.lids, targets[tissue.lids.nodes], lids)
    bone = rig.jaw.move(tissue.layers.bone, share, pitch, yaw, thrust)
    normals = rig.jaw.turn(tissue.layers.normals, share, pitch, yaw)
    load = rig.jaw.turn(np.ascontiguousarray(tissue.dead_load.T), stacked, pitch, yaw)
    still = np.zeros((n, 3))
    return Skull(*(np.ascontiguousarray(a.T) for a in (targets, bone, normals, load, still)))


def pose_held(
    rig: Rig, tissue: TissueModel, jaw: Sequence[float], lids: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Return the nodes that are moved and not simulated, and where they stand, shape (3, k).

    The outer ring turns with its share of the jaw, the tarsal plates with the lids, in all layers.
    """
    n = tissue.node_count
    pitch, yaw, thrust = jaw
    share = np.tile(rig.head.jaw_weight[:n], 3)
    places = rig.jaw.move(tissue.layers.nodes, share, pitch, yaw, thrust)
    tarsal = tissue.lids.tarsal
    if tarsal.any():
        nodes = tissue.lids.nodes[tarsal]
        for layer in range(3):
            index = nodes + layer * n
            places[index] = turn_lids(_only(tissue.lids, tarsal), places[index], lids)
    held = np.flatnonzero(np.tile(tissue.held, 3))
    return held, np.ascontiguousarray(places[held].T)


def turn_lids(lids: Lids, points: FloatArray, angles: FloatArray) -> FloatArray:
    """Return the lid `points`, shape (k, 3), turned about their eye's x axis by `angles`, (4,)."""
    theta = np.radians(angles[lids.channel]) * lids.share
    offset = points - lids.centers
    y, z = offset[:, 1], offset[:, 2]
    turned = np.stack(
        [
            offset[:, 0],
            np.cos(theta) * y - np.sin(theta) * z,
            np.sin(theta) * y + np.cos(theta) * z,
        ],
        axis=1,
    )
    return np.asarray(turned + lids.centers)


def _only(lids: Lids, keep: BoolArray) -> Lids:
    return replace(
        lids,
        nodes=lids.nodes[keep],
        channel=lids.channel[keep],
        share=lids.share[keep],
        centers=lids.centers[keep],
        tarsal=lids.tarsal[keep],
    )
