"""What every element of a course has."""

from treadwell.scenario.types import ElementName, Fraction, Table


class ElementTable(Table):
    """What every element has."""

    name: ElementName | None = None
    """What overrides, events and results call it; no two elements have the same."""
    mapped: bool = True
    """False leaves it out of the a-priori map."""
    texture: Fraction = 1.0
    """How well stereo sees it, 0 (blank) to 1."""
