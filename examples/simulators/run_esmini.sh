#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run_esmini.sh ESMINI WALKER FOLDER: builds esmini from a checkout on the system's OpenSceneGraph, and
# runs three scenarios whose pedestrians are the walker, with a picture of every step. Downloads
# nothing, and writes to FOLDER alone:
#   build/            esmini; a second run uses it again
#   SCENARIO/         pictures and log of a run
#   SCENARIO.sha256   the pictures' checksums
set -euo pipefail
[ $# = 3 ] || { sed -n '3,8s/^# \?//p' "$0" >&2; exit 2; }
fail() { echo "run_esmini.sh: $*" >&2; exit 1; }
checkout=$(realpath "$1") walker=$(realpath "$2") here=$(dirname "$(realpath "$0")")
mkdir -p "$3" && folder=$(realpath "$3")
[ -f "$checkout/resources/xosc/pedestrian.xosc" ] ||
  fail "$checkout: no resources/xosc/pedestrian.xosc, expected a checkout of esmini"
[ -f "$walker" ] || fail "$walker: no such file, expected one that osgskinbake --walker wrote"
export OSG_LIBRARY_PATH=${OSG_LIBRARY_PATH:-$(realpath "$here/../../build/release/lib")}
export OSGSKIN_WALKER_STEP=0.05 # seconds from one frame to the next
copy=$folder/esmini

build() {
  mkdir "$copy"
  tar -C "$checkout" --exclude=.git --exclude=./bin --exclude=./build -c . | tar -C "$copy" -x
  # The submodule fmt comes from Debian, and OpenSceneGraph's static archives are shared libraries.
  rm -rf "$copy/externals/fmt" && mkdir "$copy/externals/fmt"
  cat >"$copy/externals/fmt/CMakeLists.txt" <<'END'
add_library(fmt INTERFACE)
find_package(X11 REQUIRED)
find_package(OpenSceneGraph REQUIRED osgViewer osgGA osgText osgDB osgSim osgUtil osgAnimation)
foreach(plugin osg jpeg png serializers_osg serializers_osgsim)
  find_library(PLUGIN_${plugin} NAMES osgdb_${plugin}.so
    PATH_SUFFIXES osgPlugins-${OPENSCENEGRAPH_VERSION} REQUIRED)
  # A plug-in has no SONAME, for which CMake would write -losgdb_osg.
  list(APPEND OPENSCENEGRAPH_LIBRARIES "-Wl,${PLUGIN_${plugin}}")
endforeach()
set(OSG_LIBRARIES ${OPENSCENEGRAPH_LIBRARIES} ${X11_LIBRARIES} GL PARENT_SCOPE)
END
  # Git must not look for submodules in a folder above.
  GIT_CEILING_DIRECTORIES=$folder cmake -S "$copy" -B "$folder/build" -G Ninja \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="-O1 -DFMT_HEADER_ONLY" \
    -DCMAKE_CXX_FLAGS_RELEASE=-DNDEBUG -DDOWNLOAD_EXTERNALS=OFF -DUSE_OSI=OFF -DUSE_SUMO=OFF \
    -DUSE_IMPLOT=OFF -DUSE_GTEST=OFF -DBUILD_EXAMPLES=OFF -DBUILD_ODRPLOT=OFF &&
    nice cmake --build "$folder/build" --target esmini
}
esmini=$folder/build/EnvironmentSimulator/Applications/esmini/esmini
if [ ! -x "$esmini" ]; then
  rm -rf "$copy" "$folder/build"
  build >"$folder/build.log" 2>&1 ||
    { tail -n 20 "$folder/build.log"; fail "esmini does not build, see $folder/build.log"; }
fi
mkdir -p "$copy/resources/models"
cp "$walker" "$copy/resources/models/walkman.osgb"

pedestrian() { # NAME: one that walks along the road
  cat <<END
    <ScenarioObject name="$1">
      <Pedestrian name="$1" model="walker" mass="75" pedestrianCategory="pedestrian"
                  model3d="../models/walkman.osgb">
        <BoundingBox>
          <Center x="0" y="0" z="0.9"/>
          <Dimensions length="0.4" width="0.6" height="1.8"/>
        </BoundingBox>
        <Properties><Property name="scaleMode" value="$2"/></Properties>
      </Pedestrian>
    </ScenarioObject>
END
}
start() { # NAME SPEED S OFFSET
  cat <<END
      <Private entityRef="$1">
        <PrivateAction><TeleportAction><Position>
          <LanePosition roadId="1" laneId="-1" s="$3" offset="$4"/>
        </Position></TeleportAction></PrivateAction>
        <PrivateAction><LongitudinalAction><SpeedAction>
          <SpeedActionDynamics dynamicsShape="step" dynamicsDimension="time" value="0"/>
          <SpeedActionTarget><AbsoluteTargetSpeed value="$2"/></SpeedActionTarget>
        </SpeedAction></LongitudinalAction></PrivateAction>
      </Private>
END
}
cat >"$copy/resources/xosc/three_pedestrians.xosc" <<END
<?xml version="1.0" encoding="UTF-8"?>
<OpenSCENARIO>
  <FileHeader revMajor="1" revMinor="1" date="2025-01-01T00:00:00" author="osgSkin"
              description="Three pedestrians at 0, 0.7 and 1.5 m/s"/>
  <RoadNetwork><LogicFile filepath="../xodr/straight_500m.xodr"/></RoadNetwork>
  <Entities>
$(pedestrian stands None; pedestrian strolls BBToModel; pedestrian walks ModelToBB)
  </Entities>
  <Storyboard>
    <Init><Actions>
$(start stands 0 13.5 0.9; start strolls 0.7 11 0; start walks 1.5 9 -0.9)
    </Actions></Init>
    <StopTrigger><ConditionGroup>
      <Condition name="end" delay="0" conditionEdge="none">
        <ByValueCondition><SimulationTimeCondition value="5" rule="greaterThan"/></ByValueCondition>
      </Condition>
    </ConditionGroup></StopTrigger>
  </Storyboard>
</OpenSCENARIO>
END

run() { # SCENARIO OPTION...
  local out=$folder/$1
  rm -rf "$out" && mkdir "$out"
  (cd "$out" && "$here/../../cmake/with_display.sh" 1280x1024 "$esmini" --headless \
    --window 0 0 640 360 --fixed_timestep 0.05 --capture_screen --info_text 0 --hide_trajectories \
    --csv_logger positions.csv --osc "$copy/resources/xosc/$1.xosc" "${@:2}" >run.log 2>&1) ||
    { tail -n 20 "$out/run.log"; fail "esmini ends with an error, see $out/run.log"; }
  (cd "$out" && sha256sum ./*.tga) >"$out.sha256"
  echo "$1: $(wc -l <"$out.sha256") pictures in $out"
}
run pedestrian --camera_mode orbit --follow_object 1
run pedestrian_collision --camera_mode orbit --follow_object 1
run three_pedestrians --custom_fixed_camera 13,-9,2.2,1.57,0.15
