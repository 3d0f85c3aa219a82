"""Points of the plane in the programme: columns of symbols, shape (2,), and plane vectors."""

from __future__ import annotations

import casadi as ca

from grashof.synth.loop.vector import Vector


def vector(point: ca.SX) -> Vector:
    """A point, shape (2,), as a plane vector."""
    return Vector(point[0], point[1])


def column(point: Vector) -> ca.SX:
    """A plane vector as a point, shape (2,)."""
    placed: ca.SX = ca.vertcat(point.x, point.y)
    return placed


def track(points: list[ca.SX]) -> Vector:
    """Points, each of shape (2,), as one plane vector of columns."""
    return Vector(*(ca.vertcat(*(point[axis] for point in points)) for axis in (0, 1)))


def unit(angle: ca.SX) -> ca.SX:
    """Unit vector in a direction."""
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def rotated(point: ca.SX, angle: ca.SX) -> ca.SX:
    """A vector turned by an angle."""
    cos, sin = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(cos * point[0] - sin * point[1], sin * point[0] + cos * point[1])


def quarter_turn(point: ca.SX) -> ca.SX:
    """A vector turned by 90 degrees, counter-clockwise."""
    return ca.vertcat(-point[1], point[0])


def cross(first: ca.SX, second: ca.SX) -> ca.SX:
    """Cross product of two plane vectors."""
    return first[0] * second[1] - first[1] * second[0]
