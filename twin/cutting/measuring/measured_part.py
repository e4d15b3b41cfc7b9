"""A machined part compared with what it should be, whatever describes them."""

import dataclasses
from pathlib import Path

from twin.cutting.cut import Cutter
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.colours import deviation_colours
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.part import export_glb, write_glb
from twin.cutting.material import Material
from twin.cutting.measuring.inspection import Inspection, inspect
from twin.cutting.measuring.nominal import Nominal
from twin.cutting.measuring.nominal_from_above import nominal_map
from twin.cutting.measuring.tridexel_inspection import deviations, inspect_stock, nominal_stock
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.surface.mesh import Surface, part_mesh
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
from twin.units import UM_PER_MM


@dataclasses.dataclass(frozen=True, slots=True)
class MeasuredPart:
    """A machined part that was measured."""

    part: Material
    nominal: Nominal
    found: Inspection

    @property
    def scale_mm(self) -> float:
        """Deviation that has the last colours [mm]."""
        return self.found.tolerance_um / UM_PER_MM

    def deviations(self, surface: Surface) -> FloatArray:
        """How far vertices of a tri-dexel part's surface are off, as shares of the scale, shape (n,); NaN: not known."""
        assert isinstance(self.nominal, TriDexel)
        return deviations(self.nominal, surface) / self.scale_mm

    def write_glb(self, path: Path) -> None:
        """Write the part as binary glTF, coloured by its deviations, complete or not at all.

        Raises:
            OSError: The file cannot be written.
        """
        if isinstance(self.part, TriDexelMaterial):
            mesh = part_mesh(
                self.part.stock, lambda found: deviation_colours(self.deviations(found), 1.0)
            )
            export_glb(mesh, path)
        else:
            assert isinstance(self.part, HeightMapMaterial)
            colours = deviation_colours(self.found.deviation_mm, self.scale_mm)
            write_glb(self.part.map, path, colours)


def nominal_of(cutter: Cutter, file: Path, part_frame: PartFrame, part_zero: FloatArray) -> Nominal:
    """A nominal part on the grid of the machined one.

    Args:
        file: STL of the nominal part in program coordinates [mm].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

    Raises:
        ConfigError: The file cannot be read, or a part that is cut from several sides has one that is not closed.
    """
    material, corner = cutter.material, part_frame.program_zero(part_zero)
    if isinstance(material, TriDexelMaterial):
        return nominal_stock(material.stock, file, corner)
    return nominal_map(cutter.map, file, corner)


def measured(part: Material, nominal: Nominal, tolerance_um: float) -> MeasuredPart:
    """Measure a part against its nominal shape, of the same kind.

    Args:
        tolerance_um: Deviation that is still good [µm].

    Raises:
        ConfigError: The two do not lie on the same grid.
    """
    if isinstance(part, TriDexelMaterial):
        assert isinstance(nominal, TriDexel)
        return MeasuredPart(part, nominal, inspect_stock(part.stock, nominal, tolerance_um))
    assert isinstance(part, HeightMapMaterial)
    assert isinstance(nominal, HeightMap)
    return MeasuredPart(part, nominal, inspect(part.map, nominal, tolerance_um))
