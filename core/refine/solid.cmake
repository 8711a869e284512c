target_sources(
  symcell_core
  PRIVATE refine/solid_criteria.cpp
          refine/solid_refiner.cpp
          delaunay/solid_editor.cpp
          delaunay/solid_legalise.cpp
          improve/solid_collapse.cpp
          improve/solid_improver.cpp
          improve/solid_moves.cpp
          improve/solid_surgery.cpp
          mesh_solid.cpp
          refine_solid.cpp)
