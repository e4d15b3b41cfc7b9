"""What F counts on a Fanuc control, and on a Haas mill.

Fanuc, feed per minute and per revolution: a line counts all its axes together, a degree as much as 1 mm, or as
1 inch in G20 (operator's manual, linear interpolation: ``G91 G1 X20. C40. F300.`` takes 0.149 min); an arc counts
the circle in its plane, unless parameter 1403 #5 (HTG) lets it count the path of all axes. Inverse time (G93): F of
an arc is its speed by its radius, since the manual computes it of the radius and not of the distance.

Haas: rotary axes count by the surface whose diameter setting 34 holds; F of a helix counts the helix; F of G93 is
strokes per minute in every move (manual, G2, G93 and settings).
"""

import math

from twin.nc.control.settings import ControlSettings
from twin.nc.path.feed_rates import FeedRule

DEGREE_AS_LENGTH = 1.0
"""What a degree counts together with linear axes, in programmed units of length (Fanuc's manual). Decision: of a Haas
where nobody gave the diameter of setting 34 as well, which is the surface of 114.6 mm diameter."""


def fanuc_rule(settings: ControlSettings) -> FeedRule:
    """What F counts by the parameters of a Fanuc control."""
    along_path = settings.helical_feed == "path"
    return FeedRule(DEGREE_AS_LENGTH, helix_by_arc=not along_path, arc_by_radius=True)


def haas_rule(settings: ControlSettings) -> FeedRule:
    """What F counts by the settings of a Haas mill."""
    if settings.rotary_diameter is None:
        return FeedRule(DEGREE_AS_LENGTH)
    return FeedRule(math.radians(settings.rotary_diameter / 2.0), surface=True)
