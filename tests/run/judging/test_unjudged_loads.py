"""A tolerance on what nobody simulates is refused: it would pass unseen."""

from pathlib import Path

import pytest

import twin
from twin.errors import ConfigError

PROGRAM = "N10 G90 G0 X0 Y0 Z5\nN20 M3 S5000\nN30 G1 Z-1 F200\nN40 X20\nN50 G0 Z5\nN60 M30\n"
STOCK = '[stock]\nshape = "box"\nsize = [60.0, 40.0, 20.0]\n'


@pytest.mark.parametrize("key", ["force_n", "power_w", "deflection_um", "chip_mm"])
@pytest.mark.parametrize(
    ("job", "stock"),
    [("", ""), ("", STOCK), ('cutting_force = "mean"\n', f'{STOCK}material = "C45"\n')],
    ids=["no stock", "no material", "mean force"],
)
def test_a_load_that_nobody_simulates_is_not_judged_in_silence(
    tmp_path: Path, key: str, job: str, stock: str
):
    (tmp_path / "part.nc").write_text(PROGRAM)
    path = tmp_path / "part.toml"
    tools = "[[tools]]\nnumber = 1\ndiameter = 10.0\n"
    path.write_text(
        f'program = "part.nc"\ndialect = "fagor8070"\n{job}{stock}{tools}[tolerance]\n{key} = 1.0\n'
    )
    with pytest.raises(ConfigError, match=rf"tolerance\.{key}.*material"):
        twin.run(path, out=tmp_path / "out")


def test_a_speed_that_nobody_knows_is_not_judged_in_silence(tmp_path: Path) -> None:
    """CODESYS has no word for the speed: its drive turns as it is set."""
    (tmp_path / "part.nc").write_text(
        "N10 G90 G0 X0 Y0 Z5\nN15 M3\nN20 G1 Z-1 F200\nN40 X20\nN50 G0 Z5\n"
    )
    path = tmp_path / "part.toml"
    tools = "[[tools]]\nnumber = 1\ndiameter = 10.0\n"
    stock = f'{STOCK}material = "C45"\n'
    path.write_text(
        f'program = "part.nc"\ndialect = "codesys"\n{stock}{tools}[tolerance]\nforce_n = 1e6\n'
    )
    with pytest.raises(ConfigError, match=r"tolerance\.force_n.*wherever it is cut"):
        twin.run(path, out=tmp_path / "out")
