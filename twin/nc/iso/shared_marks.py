"""Marks that several controls have in common: each tells their programs from those of the others alone.

A dialect names those that its control's manual knows, also where the twin refuses what they say.
"""

from twin.nc.text.syntax import Mark

_VALUE = r"[ \t]*[-+]?[.\d]"

ADDITIONAL_OFFSET = Mark(r"\bG1(?:1[0-9]|2[0-9])(?![.\d])", "G110 to G129")
ARC_WITH_T = Mark(
    rf"^(?!.*\b[XY]{_VALUE}).*\bG0?[23]\b.*[IJK].*\bT[ \t]*\d", "an arc with the opening angle T"
)
BACK_BORING_WITH_I = Mark(rf"\bG0*87\b.*\bI{_VALUE}", "G87 with I")
BUILDERS_CODE = Mark(r"\bG187\b", "G187")
CORNER_ARC = Mark(r"\bG0*39[ \t]*I", "G39 with I")
EXACT_STOP_ARC = Mark(r"\bG0?9[ \t]*G0?[23]\b", "G09 with G02 or G03")
CYLINDER = Mark(r"\bG107[ \t]*C", "G107 C")
G102 = Mark(r"\bG102[ \t]*[A-Z]", "G102 with an axis")
G103_WITH_P = Mark(r"\bG103[ \t]*P", "G103 P")
G136 = Mark(r"\bG136\b", "G136")
G31_WITH_Q = Mark(r"\bG0*31\b.*\bQ", "G31 with Q")
G36_WITH_I = Mark(r"\bG0*36[ \t]*I", "G36 with I")
G73_WITH_Q = Mark(rf"^(?!.*\b[RZ]{_VALUE}).*\bG0*73[ \t]*Q", "G73 Q without R and Z")
NO_OFFSET = Mark(r"\bG500\b", "G500")
NUMBERED_PARAMETER_3000 = Mark(r"#300[06][ \t]*=", "#3000=1 (an alarm)")
PECKS_WITH_I = Mark(rf"\bG0*83\b.*\bI{_VALUE}", "G83 with I")
POINT_CODES = Mark(r"\bG(?:30\.1|43\.1|91\.1)(?!\d)", "G30.1, G43.1, G91.1")
PROGRAM_NUMBER = Mark(r"^[ \t]*O[ \t]*[0-9]{1,8}[ \t;]*$", "O1000 (a program's number)")
SEMICOLON = Mark(r"^[^\"$;]*;[ \t]*[^ \t;]", "text behind ;")
STORED_POSITION_OR_PROBE = Mark(r"\bG(?:28\.1|38\.[2-5])(?!\d)", "G28.1, G38.2 to G38.5")
TURNED_COMPENSATION = Mark(r"\bG4[12]\.1(?!\d)", "G41.1, G42.1")
