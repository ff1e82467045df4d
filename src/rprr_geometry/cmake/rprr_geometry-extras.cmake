# What every RPRR package builds with. Exported by rprr_geometry, which all of them stand on.
option(RPRR_WERROR "Treat compiler warnings as errors" OFF)
set(RPRR_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

find_program(RPRR_CCACHE ccache)
if(RPRR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${RPRR_CCACHE})
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Language level, warnings and sanitizers of one of our targets. No -march: binaries run on any CPU
# of the architecture.
function(rprr_target TARGET)
  target_compile_features(${TARGET} PUBLIC cxx_std_17)
  set_target_properties(${TARGET} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${TARGET} PRIVATE -Wall -Wextra -Wpedantic)
  if(RPRR_WERROR)
    target_compile_options(${TARGET} PRIVATE -Werror)
  endif()
  if(RPRR_SANITIZE)
    # Little optimised, and debugged as far as a report names lines: half the time to compile.
    target_compile_options(${TARGET} PRIVATE
      -fsanitize=${RPRR_SANITIZE} -fno-omit-frame-pointer -O1 -g1)
    target_link_libraries(${TARGET} -fsanitize=${RPRR_SANITIZE})
  endif()
endfunction()

# One gtest binary from test/<NAME>.cpp, linked with the libraries given.
function(rprr_gtest NAME)
  catkin_add_gtest(${NAME} test/${NAME}.cpp)
  rprr_target(${NAME})
  target_link_libraries(${NAME} ${ARGN} ${GTEST_MAIN_LIBRARIES} gtest_main)
endfunction()

# The two below expect include_directories(include) and SYSTEM ${catkin_INCLUDE_DIRS} before them.

# Executable <NAME> that runs the nodelet TYPE ("package/Class") as a node of its own, and its install.
function(rprr_standalone NAME TYPE)
  set(main ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp)
  file(GENERATE OUTPUT ${main} CONTENT
"#include <rprr_geometry_ros/standalone.hpp>
int main(int argc, char** argv) { return rprr::run_standalone(argc, argv, \"${TYPE}\"); }
")
  add_executable(${NAME} ${main})
  rprr_target(${NAME})
  target_link_libraries(${NAME} ${catkin_LIBRARIES})
  install(TARGETS ${NAME} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# The nodelet library rprr_<name>_nodelets from the sources given, linked with the package's core.
function(rprr_nodelets CORE)
  add_library(${CORE}_nodelets ${ARGN})
  rprr_target(${CORE}_nodelets)
  target_link_libraries(${CORE}_nodelets ${CORE} ${catkin_LIBRARIES})
  add_dependencies(${CORE}_nodelets ${catkin_EXPORTED_TARGETS})
  install(TARGETS ${CORE}_nodelets LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# Links core libraries of other RPRR packages, and nothing of ROS that those packages may also export.
function(rprr_link_cores TARGET)
  foreach(core ${ARGN})
    set(libraries ${${core}_LIBRARIES})
    list(FILTER libraries INCLUDE REGEX "lib${core}\\.")
    target_link_libraries(${TARGET} ${libraries})
  endforeach()
endfunction()
