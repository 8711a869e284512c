target_sources(
  symcell_core
  PRIVATE refine/solid_criteria.cpp
          refine/solid_refiner.cpp
          delaunay/solid_editor.cpp
          delaunay/solid_legalise.cpp
          improve/insertion_cavity.cpp
          improve/solid_collapse.cpp
          improve/solid_detours.cpp
          improve/solid_improver.cpp
          improve/solid_moves.cpp
          improve/solid_star.cpp
          improve/solid_surgery.cpp
          mesh_solid.cpp
          refine_solid.cpp)
# Hot loops over stars and cavities call nothing of CGAL and look at no floating-point flag: square
# roots and minima become single instructions.
set_source_files_properties(
  delaunay/solid_editor.cpp
  improve/insertion_cavity.cpp
  improve/solid_collapse.cpp
  improve/solid_detours.cpp
  improve/solid_improver.cpp
  improve/solid_moves.cpp
  improve/solid_star.cpp
  improve/solid_surgery.cpp
  refine/solid_criteria.cpp
  refine/solid_refiner.cpp
  tds/orbit_keys.cpp
  tds/quotient_tetrahedralization.cpp
  PROPERTIES COMPILE_OPTIONS "-fno-rounding-math;-fno-math-errno;-fno-trapping-math")
