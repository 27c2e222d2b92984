"""The kernel of the Warp peer, in Warp's language: Python by its letters, not by its types."""

# Annotations are not postponed here: Warp reads them as types when a kernel is made.

from typing import Any, NamedTuple

_FLAGS = (
    "-march=native -mllvm=-inline-threshold=9000 -mllvm=-inline-cold-callsite-threshold=3000"
    " -mllvm=-slp-recursion-max-depth=12"
)
"""Warp's own, but lanes are looked for as deep as the compiler does by itself: Warp stops at a
third of that, and the elements then take several times as long."""


class Kernels(NamedTuple):
    """The kernel for one number of lanes, and the types of its arguments."""

    vector: Any
    shared: Any
    own: Any
    advance: Any


def kernels(wp: Any, lanes: int) -> Kernels:
    """Return the kernel for vectors of `lanes` faces; `wp` is the package, started."""
    V = wp.types.vector(lanes, wp.float32)

    @wp.struct
    class Shared:
        n: wp.int32
        springs: wp.int32
        prisms: wp.int32
        quads: wp.int32
        least: wp.float32
        excess_distance: wp.float32
        gap: wp.float32
        damping: wp.float32
        ends: wp.array2d(dtype=wp.int32)
        spring_law: wp.array2d(dtype=wp.float32)
        corners: wp.array2d(dtype=wp.int32)
        fat: wp.array2d(dtype=wp.int32)
        volume_law: wp.array2d(dtype=wp.float32)
        tie_law: wp.array2d(dtype=wp.float32)
        inverse_mass: wp.array(dtype=wp.float32)

    @wp.struct
    class Own:
        targets: wp.array3d(dtype=V)
        normals: wp.array3d(dtype=V)
        load: wp.array3d(dtype=V)
        depth: wp.array3d(dtype=V)
        u: wp.array3d(dtype=V)
        v: wp.array3d(dtype=V)
        at: wp.array3d(dtype=V)
        mid_v: wp.array3d(dtype=V)
        force: wp.array3d(dtype=V)

    @wp.func
    def norm(x: V, y: V, z: V):
        length = wp.cw_mul(x, x) + wp.cw_mul(y, y) + wp.cw_mul(z, z)
        for k in range(wp.static(lanes)):
            length[k] = wp.sqrt(length[k])
        return length

    @wp.func
    def pull(t: Shared, g: int, u: wp.array3d(dtype=V), f: wp.array3d(dtype=V)):
        for s in range(t.springs):
            i, j = t.ends[s, 0], t.ends[s, 1]
            x = V(t.spring_law[s, 0]) + u[g, j, 0] - u[g, i, 0]
            y = V(t.spring_law[s, 1]) + u[g, j, 1] - u[g, i, 1]
            z = V(t.spring_law[s, 2]) + u[g, j, 2] - u[g, i, 2]
            length = norm(x, y, z)
            stretch = length - V(t.spring_law[s, 3])
            over = wp.max(stretch - V(t.spring_law[s, 7]), V(0.0))
            under = wp.min(stretch - V(t.spring_law[s, 8]), V(0.0))
            tension = stretch * t.spring_law[s, 4] + over * t.spring_law[s, 5]
            tension = wp.cw_div(tension + under * t.spring_law[s, 6], length)
            x, y, z = wp.cw_mul(tension, x), wp.cw_mul(tension, y), wp.cw_mul(tension, z)
            f[g, i, 0] = f[g, i, 0] + x
            f[g, i, 1] = f[g, i, 1] + y
            f[g, i, 2] = f[g, i, 2] + z
            f[g, j, 0] = f[g, j, 0] - x
            f[g, j, 1] = f[g, j, 1] - y
            f[g, j, 2] = f[g, j, 2] - z

    @wp.func
    def area(a: V, b: V, c: V, d: V):
        return wp.cw_mul(a, d) - wp.cw_mul(b, c)

    @wp.func
    def hold(share: V, t: Shared, e: int):
        held = share * (0.5 * t.volume_law[e, 9])
        held = wp.min(wp.max(held, V(t.volume_law[e, 12])), V(t.volume_law[e, 13]))
        pressed = wp.min(held - V(t.least), V(0.0))
        harder = wp.cw_mul(pressed, pressed) * t.volume_law[e, 11]
        return (V(1.0) - held + harder) * (0.5 * t.volume_law[e, 10])

    @wp.func
    def between(u: wp.array3d(dtype=V), g: int, a: int, b: int, n: int, k: int):
        return (u[g, b, k] + u[g, b + n, k] - u[g, a, k] - u[g, a + n, k]) * 0.5

    @wp.func
    def height(u: wp.array3d(dtype=V), g: int, a: int, n: int, k: int):
        return (u[g, a, k] - u[g, a + n, k]) * (1.0 / 3.0)

    @wp.func
    def hand_out(
        f: wp.array3d(dtype=V),
        g: int,
        a: int,
        b: int,
        c: int,
        n: int,
        k: int,
        rise: V,
        second: V,
        third: V,
    ):
        turn = second + third
        f[g, a, k] = f[g, a, k] + (rise - turn)
        f[g, b, k] = f[g, b, k] + (rise + second)
        f[g, c, k] = f[g, c, k] + (rise + third)
        f[g, a + n, k] = f[g, a + n, k] - (rise + turn)
        f[g, b + n, k] = f[g, b + n, k] + (second - rise)
        f[g, c + n, k] = f[g, c + n, k] + (third - rise)

    @wp.func
    def swell(t: Shared, g: int, u: wp.array3d(dtype=V), f: wp.array3d(dtype=V)):
        n = t.n
        for e in range(t.prisms):
            a, b, c = t.corners[e, 0], t.corners[e, 1], t.corners[e, 2]
            px = between(u, g, a, b, n, 0) + V(t.volume_law[e, 0])
            py = between(u, g, a, b, n, 1) + V(t.volume_law[e, 1])
            pz = between(u, g, a, b, n, 2) + V(t.volume_law[e, 2])
            rx = between(u, g, a, c, n, 0) + V(t.volume_law[e, 3])
            ry = between(u, g, a, c, n, 1) + V(t.volume_law[e, 4])
            rz = between(u, g, a, c, n, 2) + V(t.volume_law[e, 5])
            hx = height(u, g, a, n, 0) + height(u, g, b, n, 0) + height(u, g, c, n, 0)
            hy = height(u, g, a, n, 1) + height(u, g, b, n, 1) + height(u, g, c, n, 1)
            hz = height(u, g, a, n, 2) + height(u, g, b, n, 2) + height(u, g, c, n, 2)
            hx = hx + V(t.volume_law[e, 6])
            hy = hy + V(t.volume_law[e, 7])
            hz = hz + V(t.volume_law[e, 8])
            nx, ny, nz = area(py, pz, ry, rz), area(pz, px, rz, rx), area(px, py, rx, ry)
            force = hold(wp.cw_mul(nx, hx) + wp.cw_mul(ny, hy) + wp.cw_mul(nz, hz), t, e)
            turn, rise = force * 0.5, force * (1.0 / 3.0)
            rise_x, rise_y, rise_z = wp.cw_mul(rise, nx), wp.cw_mul(rise, ny), wp.cw_mul(rise, nz)
            second = wp.cw_mul(turn, area(ry, rz, hy, hz))
            third = wp.cw_mul(turn, area(hy, hz, py, pz))
            hand_out(f, g, a, b, c, n, 0, rise_x, second, third)
            second = wp.cw_mul(turn, area(rz, rx, hz, hx))
            third = wp.cw_mul(turn, area(hz, hx, pz, px))
            hand_out(f, g, a, b, c, n, 1, rise_y, second, third)
            second = wp.cw_mul(turn, area(rx, ry, hx, hy))
            third = wp.cw_mul(turn, area(hx, hy, px, py))
            hand_out(f, g, a, b, c, n, 2, rise_z, second, third)

    @wp.func
    def middle(u: wp.array3d(dtype=V), g: int, i: int, n: int, k: int):
        return (u[g, i, k] + u[g, i + n, k] + u[g, i + 2 * n, k]) * (1.0 / 3.0)

    @wp.func
    def diagonal(u: wp.array3d(dtype=V), g: int, a: int, b: int, n: int, k: int):
        return middle(u, g, b, n, k) - middle(u, g, a, n, k)

    @wp.func
    def center(
        u: wp.array3d(dtype=V), g: int, a: int, b: int, c: int, d: int, n: int, k: int, bone: V
    ):
        across = middle(u, g, a, n, k) + middle(u, g, c, n, k)
        return (across + middle(u, g, b, n, k) + middle(u, g, d, n, k)) * 0.25 + bone

    @wp.func
    def spread(f: wp.array3d(dtype=V), g: int, a: int, b: int, n: int, k: int, rise: V, turn: V):
        for layer in range(3):
            i, j = a + layer * n, b + layer * n
            f[g, i, k] = f[g, i, k] + (rise - turn)
            f[g, j, k] = f[g, j, k] + (rise + turn)

    @wp.func
    def cushion(
        t: Shared, g: int, u: wp.array3d(dtype=V), bone: wp.array3d(dtype=V), f: wp.array3d(dtype=V)
    ):
        n = t.n
        for q in range(t.quads):
            e = t.prisms + q
            a, b, c, d = t.fat[q, 0], t.fat[q, 1], t.fat[q, 2], t.fat[q, 3]
            px = diagonal(u, g, a, c, n, 0) + V(t.volume_law[e, 0])
            py = diagonal(u, g, a, c, n, 1) + V(t.volume_law[e, 1])
            pz = diagonal(u, g, a, c, n, 2) + V(t.volume_law[e, 2])
            rx = diagonal(u, g, b, d, n, 0) + V(t.volume_law[e, 3])
            ry = diagonal(u, g, b, d, n, 1) + V(t.volume_law[e, 4])
            rz = diagonal(u, g, b, d, n, 2) + V(t.volume_law[e, 5])
            hx = center(u, g, a, b, c, d, n, 0, bone[g, q, 0])
            hy = center(u, g, a, b, c, d, n, 1, bone[g, q, 1])
            hz = center(u, g, a, b, c, d, n, 2, bone[g, q, 2])
            nx, ny, nz = area(py, pz, ry, rz), area(pz, px, rz, rx), area(px, py, rx, ry)
            force = hold(wp.cw_mul(nx, hx) + wp.cw_mul(ny, hy) + wp.cw_mul(nz, hz), t, e)
            force = force * (1.0 / 3.0)
            rise = force * 0.25
            rise_x, rise_y, rise_z = wp.cw_mul(rise, nx), wp.cw_mul(rise, ny), wp.cw_mul(rise, nz)
            spread(f, g, a, c, n, 0, rise_x, wp.cw_mul(force, area(ry, rz, hy, hz)))
            spread(f, g, a, c, n, 1, rise_y, wp.cw_mul(force, area(rz, rx, hz, hx)))
            spread(f, g, a, c, n, 2, rise_z, wp.cw_mul(force, area(rx, ry, hx, hy)))
            spread(f, g, b, d, n, 0, rise_x, wp.cw_mul(force, area(hy, hz, py, pz)))
            spread(f, g, b, d, n, 1, rise_y, wp.cw_mul(force, area(hz, hx, pz, px)))
            spread(f, g, b, d, n, 2, rise_z, wp.cw_mul(force, area(hx, hy, px, py)))

    @wp.func
    def tie(t: Shared, o: Own, g: int, u: wp.array3d(dtype=V)):
        for i in range(t.n):
            j = 2 * t.n + i
            x = o.targets[g, i, 0] - u[g, j, 0]
            y = o.targets[g, i, 1] - u[g, j, 1]
            z = o.targets[g, i, 2] - u[g, j, 2]
            nx, ny, nz = o.normals[g, i, 0], o.normals[g, i, 1], o.normals[g, i, 2]
            depth = wp.cw_mul(x, nx) + wp.cw_mul(y, ny) + wp.cw_mul(z, nz)
            distance = wp.max(norm(x, y, z), V(t.excess_distance))
            far = V(1.0) - wp.cw_div(V(t.excess_distance), distance)
            along = V(t.tie_law[i, 0]) + far * t.tie_law[i, 2]
            inside = wp.max(depth - V(t.gap), V(0.0))
            across = depth * t.tie_law[i, 1] + inside * t.tie_law[i, 3]
            o.force[g, j, 0] = o.force[g, j, 0] + wp.cw_mul(along, x) + wp.cw_mul(across, nx)
            o.force[g, j, 1] = o.force[g, j, 1] + wp.cw_mul(along, y) + wp.cw_mul(across, ny)
            o.force[g, j, 2] = o.force[g, j, 2] + wp.cw_mul(along, z) + wp.cw_mul(across, nz)

    @wp.func
    def forces(t: Shared, o: Own, g: int, u: wp.array3d(dtype=V)):
        for i in range(3 * t.n):
            for c in range(3):
                o.force[g, i, c] = o.load[g, i, c]
        pull(t, g, u, o.force)
        swell(t, g, u, o.force)
        cushion(t, g, u, o.depth, o.force)
        tie(t, o, g, u)

    # One kernel with one call of `forces`: each more takes the compiler its ten seconds again.
    @wp.kernel(
        module="unique", enable_backward=False, module_options={"cpu_compiler_flags": _FLAGS}
    )
    def advance(t: Shared, o: Own, verlet: bool, stages: int, dt: float):
        g = wp.tid()
        half = 0.5 * dt
        drag = half * t.damping
        keep, kick = (1.0 - drag) / (1.0 + drag), dt / (1.0 + drag)
        for stage in range(stages):
            if verlet:
                for i in range(3 * t.n):
                    for c in range(3):
                        o.at[g, i, c] = o.u[g, i, c] + o.v[g, i, c] * half
            forces(t, o, g, o.at)
            for i in range(3 * t.n):
                inverse = t.inverse_mass[i]
                for c in range(3):
                    if verlet:
                        v = o.v[g, i, c] * keep + o.force[g, i, c] * (kick * inverse)
                        u = o.at[g, i, c] + v * half
                        o.v[g, i, c] = v
                        o.u[g, i, c] = u
                        o.at[g, i, c] = u
                    elif dt > 0.0 and stage % 2 == 0:
                        v = o.v[g, i, c]
                        slope = o.force[g, i, c] * inverse - v * t.damping
                        o.at[g, i, c] = o.u[g, i, c] + v * half
                        o.mid_v[g, i, c] = v + slope * half
                    elif dt > 0.0:
                        v = o.mid_v[g, i, c]
                        slope = o.force[g, i, c] * inverse - v * t.damping
                        u = o.u[g, i, c] + v * dt
                        o.u[g, i, c] = u
                        o.at[g, i, c] = u
                        o.v[g, i, c] = o.v[g, i, c] + slope * dt

    return Kernels(V, Shared, Own, advance)
