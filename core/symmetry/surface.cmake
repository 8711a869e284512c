target_sources(symcell_core PRIVATE
  surface/clean_surface.cpp
  surface/constrained_fit.cpp
  surface/deviation_guard.cpp
  surface/dissolve_patches.cpp
  surface/editable_surface.cpp
  surface/improve_surface.cpp
  surface/indexed_surface.cpp
  surface/mass_properties.cpp
  surface/mend_surface.cpp
  surface/narrow_corners.cpp
  surface/planar_patches.cpp
  surface/quotient_surface.cpp
  surface/self_intersections.cpp
  surface/shells.cpp
  surface/surface_edits.cpp
  surface/t_junctions.cpp
  surface/triangle_tree.cpp
  surface/surface_distance.cpp
  surface/weld.cpp
  symmetry/cut_curves.cpp
  symmetry/detect_surface_symmetry.cpp
  symmetry/glue_cuts.cpp
  symmetry/match_curves.cpp
  symmetry/quotient_to_sector.cpp
  symmetry/shape_symmetry.cpp
  symmetry/surface_sector_source.cpp
  symmetry/symmetrise_surface.cpp
  symmetry/wedge_cut.cpp)
if(SYMCELL_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Instrumented code of CGAL looks uninitialized to GCC, wrongly.
  set_source_files_properties(surface/mend_surface.cpp PROPERTIES COMPILE_OPTIONS -Wno-maybe-uninitialized)
endif()
