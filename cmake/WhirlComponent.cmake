# One folder is one component: a static library of its *.cpp files (or an interface, when it has none).
#   whirl_component(NAME DIR <dir> [FOLDERS <sub-folders>] [EXCLUDE <regex>] [PCH <header>] [FAST] [UNITY <n>] [DEPS <targets>])
# FOLDERS: sub-folders that belong to the component. PCH: header precompiled for it (cmake/pch/<header>.hpp). FAST: its loops count.
# UNITY: so many files a unit where WHIRL_UNITY joins files at all: a unit of many heavy templates costs more than its parts.
# Installed, it is the target whirl::NAME, and its headers stand in include/whirl/NAME (cmake/WhirlInstall.cmake).
if(WHIRL_UNITY GREATER 1)
  set(WHIRL_UNITY_BUILD ON)
else()
  set(WHIRL_UNITY_BUILD OFF)
endif()
add_library(whirl_flags INTERFACE)
target_compile_options(whirl_flags INTERFACE
  $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>>)
target_compile_features(whirl_flags INTERFACE cxx_std_20)
# The compiler's own garbage collection starts late: it takes a sixth of the time where memory is not short.
target_compile_options(whirl_flags INTERFACE
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>>)
# Eigen's alignment is pinned so that code built for different instruction sets shares one binary layout.
target_compile_definitions(whirl_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=32 EIGEN_DONT_PARALLELIZE)
target_include_directories(whirl_flags INTERFACE
  $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src> $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include/whirl>)
if(WHIRL_MARCH)
  target_compile_options(whirl_flags INTERFACE $<BUILD_INTERFACE:-march=${WHIRL_MARCH}>)
endif()

# Components whose loops count are compiled at -O3; for the rest -O1 gives the same results in three quarters of the compilation.
function(whirl_optimize TARGET LEVEL)
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:${LEVEL}>)
endfunction()

# Headers that most files of several components parse anyway, parsed once for all of them: cmake/pch/<header>.hpp
# (WHIRL_PRECOMPILE=OFF: each file by itself, which shows a missing #include). One for each level of optimisation: GCC goes on with
# the level that the header was made at, whatever the command says, or crashes.
function(whirl_precompile TARGET HEADER LEVEL)
  if(NOT WHIRL_PRECOMPILE)
    return()
  endif()
  set(pch whirl_pch_${HEADER}${LEVEL})
  if(NOT TARGET ${pch})
    file(WRITE ${CMAKE_BINARY_DIR}/pch/${HEADER}${LEVEL}.cpp "")
    add_library(${pch} OBJECT ${CMAKE_BINARY_DIR}/pch/${HEADER}${LEVEL}.cpp)
    target_link_libraries(${pch} PRIVATE whirl_flags Eigen3::Eigen fmt::fmt ${ARGN})
    whirl_optimize(${pch} ${LEVEL})
    if(HEADER STREQUAL "tests")   # programs are position-independent in another way than libraries
      set_target_properties(${pch} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${pch} PRIVATE -fPIE)
    endif()
    target_include_directories(${pch} PRIVATE ${CMAKE_SOURCE_DIR}/cmake)
    target_precompile_headers(${pch} PRIVATE <pch/${HEADER}.hpp>)
  endif()
  target_precompile_headers(${TARGET} REUSE_FROM ${pch})
endfunction()

# The fuzzer's build instruments what reads something that a user gives; these are there to be linked.
set(WHIRL_NOT_FUZZED la plot meshes)
function(whirl_component NAME)
  cmake_parse_arguments(A "FAST" "DIR;EXCLUDE;PCH;UNITY" "FOLDERS;DEPS" ${ARGN})
  set(level -O1)
  if(A_FAST)
    set(level -O3)
  endif()
  set(patterns ${A_DIR}/*.cpp)
  foreach(folder ${A_FOLDERS})
    list(APPEND patterns ${A_DIR}/${folder}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  if(A_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${A_EXCLUDE})
  endif()
  if(sources)
    add_library(whirl_${NAME} STATIC ${sources})
    target_link_libraries(whirl_${NAME} PUBLIC whirl_flags Eigen3::Eigen ${A_DEPS})
    target_compile_options(whirl_${NAME} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wshadow;-Wconversion>)
    whirl_optimize(whirl_${NAME} ${level})
    if(WHIRL_FUZZ AND NAME IN_LIST WHIRL_NOT_FUZZED)
      target_compile_options(whirl_${NAME} PRIVATE -O0 -g0 -fno-sanitize=all)
    elseif(A_PCH)
      whirl_precompile(whirl_${NAME} ${A_PCH} ${level})
    endif()
    set(batch ${WHIRL_UNITY})
    if(A_UNITY)
      set(batch ${A_UNITY})
    endif()
    set_target_properties(whirl_${NAME} PROPERTIES UNITY_BUILD ${WHIRL_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${batch})
  else()
    add_library(whirl_${NAME} INTERFACE)
    target_link_libraries(whirl_${NAME} INTERFACE whirl_flags Eigen3::Eigen ${A_DEPS})
  endif()
  set_property(GLOBAL APPEND PROPERTY WHIRL_COMPONENTS ${NAME})
  set_property(GLOBAL PROPERTY WHIRL_FOLDER_${NAME} ${A_DIR})
endfunction()

# A test program of all test_*.cpp in a folder; each GoogleTest case becomes a CTest test.
# UNITY: so many files a unit, where WHIRL_UNITY joins files at all and the folder's files share no names.
function(whirl_tests NAME)
  cmake_parse_arguments(A "" "DIR;LABEL;TIMEOUT;PCH;UNITY" "DEPS;PROPERTIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${A_DIR}/test_*.cpp)
  if(sources)
    add_executable(test_${NAME} ${sources})
    target_link_libraries(test_${NAME} PRIVATE ${A_DEPS} GTest::gtest_main)
    whirl_optimize(test_${NAME} -O1)
    if(A_PCH)
      whirl_precompile(test_${NAME} ${A_PCH} -O1 GTest::gtest)
    endif()
    if(A_UNITY)
      set_target_properties(test_${NAME} PROPERTIES UNITY_BUILD ${WHIRL_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${A_UNITY})
      if(WHIRL_UNITY_BUILD)   # fixtures in unnamed namespaces stand in an included file then
        target_compile_options(test_${NAME} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
      endif()
    endif()
    set(timeout)
    if(A_TIMEOUT)
      set(timeout TIMEOUT ${A_TIMEOUT})   # seconds: a test that never ends fails
    endif()
    gtest_discover_tests(test_${NAME} TEST_PREFIX "${NAME}." DISCOVERY_TIMEOUT 60 WORKING_DIRECTORY ${A_DIR}
                         PROPERTIES LABELS "${A_LABEL}" ${timeout} ${A_PROPERTIES})
  endif()
endfunction()
