# A plug-in: a shared module that nothing links; whirl::Plugin::load() opens it when a run needs it.
# whirl_plugin(NAME SOURCES <files> LIBS <targets>). All stand in one folder of the build tree.
include_guard(GLOBAL)
function(whirl_plugin NAME)
  cmake_parse_arguments(A "" "" "SOURCES;LIBS" ${ARGN})
  add_library(whirl_plugin_${NAME} MODULE ${A_SOURCES})
  set_target_properties(whirl_plugin_${NAME} PROPERTIES
    OUTPUT_NAME whirl_${NAME} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(whirl_plugin_${NAME} PRIVATE whirl_flags Eigen3::Eigen ${A_LIBS})
  install(TARGETS whirl_plugin_${NAME} LIBRARY DESTINATION lib/whirl COMPONENT ${NAME})
  set_property(GLOBAL APPEND PROPERTY WHIRL_PLUGINS ${NAME})
endfunction()
