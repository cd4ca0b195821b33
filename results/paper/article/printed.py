"""What the article prints: tables 1 to 4, quoted segments, curves with coefficients, thresholds."""

from __future__ import annotations

from typing import Callable, NamedTuple

import numpy as np

from article.cells import ORB
from article.verdicts import plain


class Row(NamedTuple):
    """One row of tables 1 to 4; all errors along one axis [m]."""

    table: int
    sequence: str
    axis: str
    variant: str  #: ORB_SLAM2, or N3..N5, M6..M8
    max: float
    min: float
    mean: float
    ate: float
    rpe: float

    def contradiction(self):
        """Why the row is inconsistent if ATE is the RMSE of the same errors: mean <= RMSE, and an
        RPE along the same axis is at most twice the ATE. Empty if it is consistent."""
        out = []
        if self.mean > self.ate:
            out.append(f"mean {plain(self.mean)} exceeds ATE {plain(self.ate)}")
        if self.rpe > 2 * self.ate:
            out.append(f"RPE is {self.rpe / self.ate:.2f} times the ATE, at most 2 is possible for"
                       " errors of the same axis")
        return "; ".join(out)


# The OCR scrambled the rows of table 3; they are assigned by the printed N.
ROWS = [
    Row(1, "fr1_room", "y", ORB, 0.0900, 0.0008, 0.0670, 0.0557, 0.0125),
    Row(1, "fr1_room", "y", "N3", 0.0888, 0.0003, 0.0296, 0.0365, 0.1045),
    Row(1, "fr1_room", "y", "N4", 0.1417, 0.0001, 0.0329, 0.0410, 0.0089),
    Row(1, "fr1_room", "y", "N5", 0.1332, 0.0001, 0.0335, 0.0423, 0.1184),
    Row(2, "fr1_room", "z", ORB, 0.0773, 0.0001, 0.0144, 0.0193, 0.0135),
    Row(2, "fr1_room", "z", "M6", 0.0720, 0.0001, 0.0130, 0.0173, 0.0106),
    Row(2, "fr1_room", "z", "M7", 0.2073, 0.0002, 0.0198, 0.0341, 0.0232),
    Row(2, "fr1_room", "z", "M8", 0.0697, 0.0001, 0.0153, 0.0215, 0.0113),
    Row(3, "fr3_office", "y", ORB, 0.1466, 0.0001, 0.0203, 0.0234, 0.0183),
    Row(3, "fr3_office", "y", "N3", 0.1401, 0.0002, 0.0178, 0.0231, 0.0196),
    Row(3, "fr3_office", "y", "N4", 0.1063, 0.0001, 0.0174, 0.0238, 0.0185),
    Row(3, "fr3_office", "y", "N5", 0.1675, 0.0005, 0.0272, 0.03997, 0.0186),
    Row(4, "fr3_office", "z", ORB, 0.1466, 0.0001, 0.0622, 0.0780, 0.1068),
    Row(4, "fr3_office", "z", "M6", 0.1727, 0.0001, 0.0364, 0.0262, 0.1691),
    Row(4, "fr3_office", "z", "M7", 0.1490, 0.0001, 0.0154, 0.0332, 0.0141),
    Row(4, "fr3_office", "z", "M8", 0.1564, 0.0002, 0.0146, 0.0314, 0.0133),
]


class Segment(NamedTuple):
    """Segment quoted beside a figure, with the curve that the article calls best there."""

    where: str
    sequence: str
    candidate: str  #: N and family; sine and rational are printed without N
    speed: tuple[float, float]  #: [m/s]
    kappa: tuple[float, float]  #: printed without unit; read as [rad] per keyframe


SPECIAL = "Text, special segment"
SEGMENTS = [
    Segment("Figure 5 a c e", "fr1_room", "N3 parabola", (0.3845, 0.7014), (0.002, 0.04)),
    Segment("Figure 5 b d f", "fr1_room", "N4 cubic", (0.2214, 0.4508), (0.005, 0.018)),
    Segment("Figure 6 a c e", "fr1_room", "N4 parabola", (0.1331, 0.4580), (0.0071, 0.0265)),
    Segment(SPECIAL, "fr1_room", "N5 sine", (0.1006, 0.1770), (0.0548, 0.0586)),
    Segment("Figure 7 a c e", "fr3_office", "N4 parabola", (0.2017, 0.3832), (0.0357, 0.0512)),
    Segment("Figure 7 b d f", "fr3_office", "N5 cubic", (0.2670, 0.2774), (0.0011, 0.0032)),
    Segment("Figure 8 left", "fr3_office", "N4 parabola", (0.1998, 0.3035), (0.0071, 0.0265)),
    Segment(SPECIAL, "fr3_office", "N5 rational", (0.1006, 0.1770), (0.1271, 0.2248)),
]


class Values(NamedTuple):
    """Values printed for one sequence."""

    sequence: str
    images: int
    keyframes: int
    length: float  #: [m]
    slowest: float  #: between keyframes [m/s]
    fastest: float
    speed_band: float  #: [m/s]
    turn_max: float  #: no unit; assumed [rad] per keyframe


VALUES = [
    Values("fr1_room", 1362, 180, 15.989, 0.0593, 1.3648, 0.33, 0.75),
    Values("fr3_office", 2585, 204, 21.455, 0.0372, 0.4292, 0.25, 0.42),
]


def _polynomial(c, x):
    out = 0.0
    for each in c:  # the highest power first
        out = out * x + each
    return out


def _sine(c, x):
    return c[0] * np.sin(c[1] * x + c[2])


def _rational(c, x):
    return c[0] / (x * x + c[1] * x + c[2])


class Curve(NamedTuple):
    """y = f(x) with printed coefficients, in the reference's axes [m]."""

    where: str
    sequence: str
    text: str
    nodes: int  #: N quoted as best, or 5
    speed: tuple[float, float]  #: quoted there [m/s]
    coefficients: tuple[float, ...]
    family: Callable = _polynomial

    def f(self, x, factors=1.0):
        """Heights at x [m], with every coefficient multiplied by a factor."""
        return self.family(np.multiply(self.coefficients, factors), x)


_SINE, _RATIONAL = (2.007, 104.6, -32.08), (1.253, 6.981, -8.05)
CURVES = [
    Curve("Figure 5 a c e", "fr1_room", "parabola 1.238, 0.07842, -0.5163", 3,
          SEGMENTS[0].speed, (1.238, 0.07842, -0.5163)),
    Curve("Figure 5 b d f", "fr1_room", "cubic -1.779, 0.4036, 0.7173, -17.71", 4,
          SEGMENTS[1].speed, (-1.779, 0.4036, 0.7173, -17.71)),
    Curve("Figure 5 b d f, constant read as -0.1771", "fr1_room",
          "cubic -1.779, 0.4036, 0.7173, -0.1771", 4, SEGMENTS[1].speed,
          (-1.779, 0.4036, 0.7173, -0.1771)),
    Curve("Figure 6 a c e", "fr1_room", "parabola 1.336, -0.2775, -0.7645", 4,
          SEGMENTS[2].speed, (1.336, -0.2775, -0.7645)),
    Curve(SPECIAL, "fr1_room", "2.007 sin(104.6 x - 32.08)", 5, SEGMENTS[3].speed, _SINE, _sine),
    Curve("Figure 7 a c e", "fr3_office", "parabola -1.695, 3.683, -0.8821", 4,
          SEGMENTS[4].speed, (-1.695, 3.683, -0.8821)),
    Curve("Figure 7 b d f", "fr3_office", "cubic 1.966, 8.281, 15.32, 5.843", 5,
          SEGMENTS[5].speed, (1.966, 8.281, 15.32, 5.843)),
    Curve("Figure 8 left", "fr3_office", "parabola -2.943, -19.3, -31.76", 4,
          SEGMENTS[6].speed, (-2.943, -19.3, -31.76)),
    Curve(SPECIAL, "fr3_office", "1.253 / (x^2 + 6.981 x - 8.05)", 5, SEGMENTS[7].speed, _RATIONAL,
          _rational),
]


class Quadric(NamedTuple):
    """z = q(x, y) with printed coefficients of x^2, y^2, x y, y, x, 1 [m]."""

    where: str
    sequence: str
    text: str
    beta: tuple[float, ...]

    def height(self, x, y, factors=1.0):
        b = np.multiply(self.beta, factors)
        return b[0] * x * x + b[1] * y * y + b[2] * x * y + b[3] * y + b[4] * x + b[5]


QUADRICS = [
    Quadric("Figure 6 b d f", "fr1_room",
            "quadric -0.06873, -0.07766, 0.02006, 0.1498, -0.03972, 1.421",
            (-0.06873, -0.07766, 0.02006, 0.1498, -0.03972, 1.421)),
    Quadric("Figure 8 right", "fr3_office",
            "quadric -4.73, 0.482, 1.685, -1.523, 10.77, -4.589",
            (-4.73, 0.482, 1.685, -1.523, 10.77, -4.589)),
]
