"""What insight is asked and answers: analyses of faces, and the inverse."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field, StrictBool

from .bodies import Body, Name, Number

Place = Annotated[list[Number | None], Field(min_length=3, max_length=3)]


class MuscleLine(BaseModel):
    """One muscle of a face."""

    name: str
    activation: float = Field(description="As the tissue feels it, behind its command by a lag.")
    force: float = Field(description="Sum of its nodal forces' sizes, paper stiffness unit x mm.")
    force_mN: float = Field(description="The same in mN: one unit is 17.3 g/s².")
    length_mm: float | None = Field(
        default=None, description="From attachment to insertion, or around a sphincter's ring."
    )
    contraction_mm: float | None = Field(
        default=None, description="By how much shorter than at rest; negative if stretched."
    )
    contraction_share: float | None = None
    turn_degrees: list[float] | None = Field(
        default=None, description="Turn of the upper and lower lid, for muscles that turn lids."
    )


class SpreadBody(BaseModel):
    """Shares of the length at rest."""

    mean: float
    p95: float
    max: float


class StrainBody(BaseModel):
    """Strain of the springs along one layer."""

    tension: SpreadBody
    compression: SpreadBody


class EnergyBody(BaseModel):
    """Elastic energy above the face at rest, paper stiffness unit x mm²."""

    total: float
    total_uJ: float
    terms: dict[str, float]


class RegionBody(BaseModel):
    """One region of the skin, all layers under it included."""

    energy: float
    energy_uJ: float
    layers: dict[str, StrainBody]


class MeasuredUnitBody(BaseModel):
    """One action unit, asked for or seen."""

    unit: str
    side: str = Field(description="Empty for both, L or R.")
    requested: float
    measured: float | None = Field(description="Null for a unit that moves no tissue.")
    shown_as: str | None = Field(default=None, description="A unit that looks the same.")


class FightBody(BaseModel):
    """Two units that hold each other back, the one that lost more first."""

    units: list[str]
    opposed: float
    requested: list[float]
    measured: list[float]


class AntagonistsBody(BaseModel):
    """Two active muscles that pull the same tissue opposite ways."""

    muscles: list[str]
    opposed: float


class MeasuredBody(BaseModel):
    """What the face shows."""

    action_units: list[MeasuredUnitBody]
    fights: list[FightBody]
    antagonists: list[AntagonistsBody]
    residual: float = Field(description="Share of the motion that no unit explains.")


class MeasuringBody(BaseModel):
    """Work on what each action unit of a rig looks like, done once for each rig."""

    progress: float = Field(description="Share of it that is done, 0 to 1.")
    message: str


class AnalysisBody(BaseModel):
    """A face looked into."""

    rig: str
    tick: int
    muscles: list[MuscleLine]
    layers: dict[str, StrainBody]
    energy: EnergyBody
    regions: dict[str, RegionBody]
    measured: MeasuredBody | None = Field(
        default=None, description="Null while it is being measured; absent if not asked for."
    )
    measuring: MeasuringBody | None = None


class InverseRequest(Body):
    """Where landmarks are to go, and what may bring them there."""

    targets: dict[Name, Place] = Field(
        min_length=1,
        max_length=1024,
        description="Displacement from rest by landmark, mm; null leaves an axis open.",
        examples=[{"M1_5.L": [4.0, 9.0, -4.0], "M1_5.R": [0.0, 0.0, None]}],
    )
    weights: dict[Name, Number] | None = Field(
        default=None, description="Of landmarks; 1 where not named."
    )
    muscles: Annotated[list[Name], Field(max_length=256)] | None = Field(
        default=None, description="Those that may act, with or without side; all but air if null."
    )
    action_units: Annotated[list[Name], Field(max_length=128)] | None = Field(
        default=None, description="Units to search in place of muscles: AU12, L12."
    )
    jaw: StrictBool = Field(default=True, description="Whether the jaw may move.")
    regularization: Number | None = Field(
        default=None,
        description="Misfit of one landmark, mm, that a muscle's full activation is worth.",
    )
    iterations: Annotated[int, Field(ge=1, le=30)] = 12


class ReachedBody(BaseModel):
    """One landmark: where it was wanted, and where it is."""

    name: str
    target: list[float | None]
    reached: list[float]
    residual_mm: float


class InverseBody(BaseModel):
    """The controls that bring landmarks nearest to their targets."""

    rig: str
    activations: dict[str, float] = Field(description="Of each muscle that acts, to 1.5.")
    action_units: dict[str, float]
    jaw: dict[str, float] = Field(description="Degrees of pitch and yaw, mm of thrust.")
    landmarks: list[ReachedBody]
    rms_mm: float
    iterations: int
    converged: bool
