<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="symcell" tests="1" failures="0" errors="1">
  <testsuite name="a.json" tests="1" failures="0" errors="1" time="0.033">
    <testcase classname="a.json" name="mesh" time="0.033">
      <error type="unknown_format" message="this is a web page or other XML, not a model; send JSON (a planar or a solid model), DXF, FEMM's .fem, .poly, .smesh, STEP, IGES, STL, OFF, PLY or OBJ"/>
    </testcase>
  </testsuite>
</testsuites>
