"""Risorius engine: a physically simulated face, driven by the Facial Action Coding System.

It implements "Animation of Facial Expressions by Physical Modeling" (Zhang, Prakash, Sung,
Eurographics 2001). A face is a rig; commands are keyframes; a simulator plays them.
"""

from .analysis import Analysis, UnitBasis, analyze, analyze_facs, unit_basis
from .arkit import arkit_blend, arkit_shapes, arkit_table
from .blend import Blend, Shape, ShapeTable, blend, split_name
from .clip import Clip, clip_of, record
from .combination import Combination
from .conditions import TISSUE_AGES, plain_changes
from .edit_schema import muscle_edit_schema, tissue_edit_schema
from .emotion import Emotion
from .errors import (
    Cancelled,
    Diverged,
    EngineError,
    InvalidHead,
    InvalidNotation,
    InvalidTrack,
    InvalidValue,
    UnknownName,
)
from .face import FaceState
from .facs import (
    LETTERS,
    LIPS,
    NEUTRAL,
    PARTED,
    REGIONS,
    SCALES,
    ActionUnit,
    FacsWarning,
    Term,
    broken_rules,
    facs_codes,
    format_facs,
    letter_of,
    parse_facs,
    part_name,
    print_facs,
    split_side,
    term_of,
    whole_of,
)
from .flesh import Flesh, examine, jolts, path_dependence, random_mixes
from .frame import Frame, Pose
from .gltf import FORMS as CLIP_FORMS
from .gltf import (
    ClipFile,
    arkit_to_glb,
    clip_file,
    clip_to_glb,
    face_to_glb,
    performance_of,
    rig_to_glb,
    surface_to_glb,
    targets_to_glb,
    tissue_to_glb,
)
from .head import LEVELS, Person, Recipe, people, recipe_attributes
from .head.textures import head_textures
from .held import hold_units, recipe_of, unit_key
from .idle import IDLE, MOST_LIFE, Idle, end_of_life, idle_keyframes
from .inverse import Inverse, Response, invert, question_of, response_of, search_for
from .jaw import JawHinge
from .kept import keep, read_kept
from .landmarks import LANDMARKS_68, landmarks_68
from .measure import LANDMARKS, measure_units
from .muscle import AirPressure
from .performance import Performance
from .quality import judge
from .rig import (
    BUILTIN_RIGS,
    MAX_ACTIVATION,
    MODEL_CHOICES,
    Model,
    Rig,
    builtin_rig,
    rig_from_recipe,
)
from .separability import ALIKE, MOST_ALIKE, Separability, separability
from .settling import settled, settled_arkit, settled_units
from .simulator import Simulator, Snapshot
from .sources import ENGINE_HASH
from .speech import LEAD, LETS_GO, SPEAKER, Cue, cues_of, speech_keyframes
from .textures import bake_textures, texture_names, textures_of
from .timeline import (
    ANYONE,
    LAYERS,
    LONGEST_ONSET,
    OWNER,
    TICKS_PER_SECOND,
    Keyframe,
    Timeline,
    ticks,
    usual_layer,
)
from .trackers import (
    NEUTRAL_QUANTILE,
    Track,
    TrackOptions,
    TrackReport,
    read_track,
    track_timeline,
)
from .version import version
from .visemes import viseme_blend, viseme_shapes, viseme_table
from .vocabulary import (
    Lexicon,
    Resolved,
    lexicon,
    resolve_coordinates,
    resolve_label,
    resolve_scores,
)
from .warming import compile_motion, kernels_are_kept, warm_kernels, warm_surface
from .writers import Writers

__all__ = [
    "ALIKE",
    "ANYONE",
    "BUILTIN_RIGS",
    "CLIP_FORMS",
    "ENGINE_HASH",
    "IDLE",
    "LANDMARKS",
    "LANDMARKS_68",
    "LAYERS",
    "LEAD",
    "LETS_GO",
    "LETTERS",
    "LEVELS",
    "LIPS",
    "LONGEST_ONSET",
    "MAX_ACTIVATION",
    "MODEL_CHOICES",
    "MOST_ALIKE",
    "MOST_LIFE",
    "NEUTRAL",
    "NEUTRAL_QUANTILE",
    "OWNER",
    "PARTED",
    "REGIONS",
    "SCALES",
    "SPEAKER",
    "TICKS_PER_SECOND",
    "TISSUE_AGES",
    "ActionUnit",
    "AirPressure",
    "Analysis",
    "Blend",
    "Cancelled",
    "Clip",
    "ClipFile",
    "Combination",
    "Cue",
    "Diverged",
    "Emotion",
    "EngineError",
    "FaceState",
    "FacsWarning",
    "Flesh",
    "Frame",
    "Idle",
    "InvalidHead",
    "InvalidNotation",
    "InvalidTrack",
    "InvalidValue",
    "Inverse",
    "JawHinge",
    "Keyframe",
    "Lexicon",
    "Model",
    "Performance",
    "Person",
    "Pose",
    "Recipe",
    "Resolved",
    "Response",
    "Rig",
    "Separability",
    "Shape",
    "ShapeTable",
    "Simulator",
    "Snapshot",
    "Term",
    "Timeline",
    "Track",
    "TrackOptions",
    "TrackReport",
    "UnitBasis",
    "UnknownName",
    "Writers",
    "analyze",
    "analyze_facs",
    "arkit_blend",
    "arkit_shapes",
    "arkit_table",
    "arkit_to_glb",
    "bake_textures",
    "blend",
    "broken_rules",
    "builtin_rig",
    "clip_file",
    "clip_of",
    "clip_to_glb",
    "compile_motion",
    "cues_of",
    "end_of_life",
    "examine",
    "face_to_glb",
    "facs_codes",
    "format_facs",
    "head_textures",
    "hold_units",
    "idle_keyframes",
    "invert",
    "jolts",
    "judge",
    "keep",
    "kernels_are_kept",
    "landmarks_68",
    "letter_of",
    "lexicon",
    "measure_units",
    "muscle_edit_schema",
    "parse_facs",
    "part_name",
    "path_dependence",
    "people",
    "performance_of",
    "plain_changes",
    "print_facs",
    "question_of",
    "random_mixes",
    "read_kept",
    "read_track",
    "recipe_attributes",
    "recipe_of",
    "record",
    "resolve_coordinates",
    "resolve_label",
    "resolve_scores",
    "response_of",
    "rig_from_recipe",
    "rig_to_glb",
    "search_for",
    "separability",
    "settled",
    "settled_arkit",
    "settled_units",
    "speech_keyframes",
    "split_name",
    "split_side",
    "surface_to_glb",
    "targets_to_glb",
    "term_of",
    "texture_names",
    "textures_of",
    "ticks",
    "tissue_edit_schema",
    "tissue_to_glb",
    "track_timeline",
    "unit_basis",
    "unit_key",
    "usual_layer",
    "version",
    "viseme_blend",
    "viseme_shapes",
    "viseme_table",
    "warm_kernels",
    "warm_surface",
    "whole_of",
]
