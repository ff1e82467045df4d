# What every RPRR package builds with. Exported by rprr_geometry, which all of them stand on.
#
#   rprr_core      a library that knows no ROS
#   rprr_nodelets  a library of nodelets, and an executable for each that runs it as a node
#   rprr_gtest     a program of unit tests
#
# All take SOURCES, CORES (core libraries of other RPRR packages that are linked) and LIBRARIES.
option(RPRR_WERROR "Treat compiler warnings as errors" OFF)
set(RPRR_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

find_program(RPRR_CCACHE ccache)
if(RPRR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${RPRR_CCACHE})
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# rprr_target(TARGET [LEVEL]): language level, warnings and sanitizers of one of our targets. No
# -march: binaries run on any CPU of the architecture. LEVEL: how far a Release build optimises, if
# less than elsewhere: what touches no pixels need not be fast, and compiles sooner with 1.
function(rprr_target TARGET)
  target_compile_features(${TARGET} PUBLIC cxx_std_17)
  set_target_properties(${TARGET} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${TARGET} PRIVATE -Wall -Wextra -Wpedantic)
  if(RPRR_WERROR)
    target_compile_options(${TARGET} PRIVATE -Werror)
  endif()
  if(ARGC GREATER 1)
    target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O${ARGV1}>)
  endif()
  if(RPRR_SANITIZE)
    # Little optimised, and debugged as far as a report names lines: half the time to compile.
    target_compile_options(${TARGET} PRIVATE
      -fsanitize=${RPRR_SANITIZE} -fno-omit-frame-pointer -O1 -g1)
    target_link_libraries(${TARGET} -fsanitize=${RPRR_SANITIZE})
  endif()
endfunction()

# Compiles up to eight files of a target as one, for tests and tools: reading headers is most of
# their work. What is in their anonymous namespaces needs names of its own.
function(rprr_unity TARGET)
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# Links core libraries of other RPRR packages, with their headers, and nothing of ROS that those
# packages may also export.
function(rprr_link_cores TARGET)
  foreach(core ${ARGN})
    if(TARGET ${core})
      target_link_libraries(${TARGET} ${core})
      continue()
    endif()
    target_include_directories(${TARGET} SYSTEM PRIVATE ${${core}_INCLUDE_DIRS})
    set(libraries ${${core}_LIBRARIES})
    list(FILTER libraries INCLUDE REGEX "lib${core}\\.")
    if(NOT libraries)
      message(FATAL_ERROR "${TARGET}: core ${core} is not among this package's dependencies")
    endif()
    target_link_libraries(${TARGET} ${libraries})
  endforeach()
endfunction()

# ROS's headers may lie where every compiler looks (Debian: /usr/include), so that leaving a path
# out does not keep them out of a core. Headers of the same names that refuse come first instead:
# all of ROS includes <ros/...> sooner or later, messages as well.
function(rprr_without_ros TARGET)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/without_ros)
  if(NOT EXISTS ${folder}/ros/ros.h)
    set(names ros.h time.h duration.h types.h serialization.h message_traits.h)
    foreach(path ${catkin_INCLUDE_DIRS} /usr/include)
      file(GLOB headers RELATIVE ${path}/ros ${path}/ros/*.h)
      list(APPEND names ${headers})
    endforeach()
    list(REMOVE_DUPLICATES names)
    foreach(name ${names})
      file(WRITE ${folder}/ros/${name} "#error \"a core library of RPRR must not know ROS\"\n")
    endforeach()
  endif()
  target_include_directories(${TARGET} BEFORE PRIVATE ${folder})
endfunction()

# rprr_core([NAME name] SOURCES ... [CORES ...] [LIBRARIES ...]): the core library of the package,
# of its name if no other is given, and what installs it.
function(rprr_core)
  cmake_parse_arguments(CORE "" "NAME" "SOURCES;CORES;LIBRARIES" ${ARGN})
  if(NOT CORE_NAME)
    set(CORE_NAME ${PROJECT_NAME})
  endif()
  add_library(${CORE_NAME} ${CORE_SOURCES})
  rprr_target(${CORE_NAME})
  rprr_without_ros(${CORE_NAME})
  target_include_directories(${CORE_NAME} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> PRIVATE src)
  target_include_directories(${CORE_NAME} SYSTEM PUBLIC
    ${EIGEN3_INCLUDE_DIRS} ${OpenCV_INCLUDE_DIRS})
  rprr_link_cores(${CORE_NAME} ${CORE_CORES})
  target_link_libraries(${CORE_NAME} opencv_core ${CORE_LIBRARIES})
  install(TARGETS ${CORE_NAME} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# rprr_nodelets([NAME name] SOURCES ... [NODES node=Class ...] [CORES ...] [LIBRARIES ...]): the
# library <package>_nodelets with sources in src_ros/. Each of NODES is an executable that runs the
# nodelet <package>/<Class> as a node of its own. The package needs rprr_ros.
function(rprr_nodelets)
  cmake_parse_arguments(NODELETS "" "NAME" "SOURCES;NODES;CORES;LIBRARIES" ${ARGN})
  if(NOT NODELETS_NAME)
    set(NODELETS_NAME ${PROJECT_NAME}_nodelets)
  endif()
  add_library(${NODELETS_NAME} ${NODELETS_SOURCES})
  rprr_target(${NODELETS_NAME} 2)
  target_include_directories(${NODELETS_NAME} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> PRIVATE src_ros)
  target_include_directories(${NODELETS_NAME} SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
  rprr_link_cores(${NODELETS_NAME} ${NODELETS_CORES})
  target_link_libraries(${NODELETS_NAME} ${catkin_LIBRARIES} ${NODELETS_LIBRARIES})
  if(catkin_EXPORTED_TARGETS OR ${PROJECT_NAME}_EXPORTED_TARGETS)
    add_dependencies(${NODELETS_NAME} ${catkin_EXPORTED_TARGETS} ${${PROJECT_NAME}_EXPORTED_TARGETS})
  endif()
  install(TARGETS ${NODELETS_NAME} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  foreach(node ${NODELETS_NODES})
    string(REPLACE "=" ";" node ${node})
    list(GET node 0 name)
    list(GET node 1 class)
    rprr_standalone(${name} ${PROJECT_NAME}/${class})
  endforeach()
endfunction()

# Executable <NAME> that runs the nodelet TYPE ("package/Class") as a node of its own.
function(rprr_standalone NAME TYPE)
  set(main ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp)
  file(GENERATE OUTPUT ${main} CONTENT
"#include <rprr_ros/standalone.hpp>
int main(int argc, char** argv) { return rprr::run_standalone(argc, argv, \"${TYPE}\"); }
")
  add_executable(${NAME} ${main})
  rprr_target(${NAME} 1)
  target_include_directories(${NAME} SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(${NAME} ${catkin_LIBRARIES})
  install(TARGETS ${NAME} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# rprr_gtest(NAME [TESTS ...] [CORES ...] [LIBRARIES ...]): a gtest binary from test/<TEST>.cpp of
# each of TESTS, or from test/<NAME>.cpp, which sees private headers of the package as well. Tests
# may use ROS and link what they name.
function(rprr_gtest NAME)
  cmake_parse_arguments(TEST "" "" "TESTS;CORES;LIBRARIES" ${ARGN})
  if(NOT TEST_TESTS)
    set(TEST_TESTS ${NAME})
  endif()
  list(TRANSFORM TEST_TESTS REPLACE "(.+)" "test/\\1.cpp")
  catkin_add_gtest(${NAME} ${TEST_TESTS})
  rprr_unity(${NAME})
  rprr_test_target(${NAME} CORES ${TEST_CORES} LIBRARIES ${TEST_LIBRARIES} ${GTEST_MAIN_LIBRARIES}
    gtest_main)
endfunction()

# rprr_rostest(NAME FILES ... [CORES ...] [LIBRARIES ...] [DEPENDENCIES ...]): a gtest binary from
# test/<NAME>.cpp that the launch files test/<FILE>.test run, each as a test of its own.
function(rprr_rostest NAME)
  cmake_parse_arguments(TEST "" "" "FILES;CORES;LIBRARIES;DEPENDENCIES" ${ARGN})
  add_executable(${NAME} EXCLUDE_FROM_ALL test/${NAME}.cpp)
  rprr_test_target(${NAME} CORES ${TEST_CORES} LIBRARIES ${TEST_LIBRARIES} ${catkin_LIBRARIES}
    ${GTEST_LIBRARIES} gtest)
  if(catkin_EXPORTED_TARGETS OR TEST_DEPENDENCIES)
    add_dependencies(${NAME} ${catkin_EXPORTED_TARGETS} ${TEST_DEPENDENCIES})
  endif()
  add_dependencies(tests ${NAME})
  foreach(file ${TEST_FILES})
    add_rostest(test/${file}.test DEPENDENCIES ${NAME})
    rprr_takes_seconds(rostest_test_${file}.test 20)
  endforeach()
endfunction()

# Where several tests run at once, the long ones begin first. NAME: type and name, as in
# "rostest_test_x.test".
function(rprr_takes_seconds NAME SECONDS)
  set_tests_properties(_ctest_${PROJECT_NAME}_${NAME} PROPERTIES COST ${SECONDS})
endfunction()

function(rprr_test_target NAME)
  cmake_parse_arguments(TEST "" "" "CORES;LIBRARIES" ${ARGN})
  rprr_target(${NAME} 1)
  target_include_directories(${NAME} PRIVATE include src src_ros)
  target_include_directories(${NAME} SYSTEM PRIVATE
    ${catkin_INCLUDE_DIRS} ${EIGEN3_INCLUDE_DIRS} ${OpenCV_INCLUDE_DIRS})
  rprr_link_cores(${NAME} ${TEST_CORES})
  target_link_libraries(${NAME} ${TEST_LIBRARIES})
endfunction()
