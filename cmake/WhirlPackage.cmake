# `cpack` in the build folder: Debian packages whirl (program), whirl-<plug-in> for each, and libwhirl-dev (headers, static
# libraries). The program runs without its plug-ins, so it recommends them; dpkg-shlibdeps finds what each links.
get_property(plugins GLOBAL PROPERTY WHIRL_PLUGINS)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME whirl)
set(CPACK_PACKAGE_CONTACT "The Whirl developers <whirl@whirl.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${CMAKE_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development ${plugins})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME whirl)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The program: reads a shaft-model deck; computes statics, whirl modes, Campbell diagrams,
stability, unbalance response and run-up transients.")
list(TRANSFORM plugins PREPEND "whirl-" OUTPUT_VARIABLE recommended)
list(JOIN recommended ", " CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libwhirl-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)   # nothing linked in it: what a user's program needs is named
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libexpat1-dev, libfmt-dev, libmd-dev, libminizip-dev, libpng-dev, libsuitesparse-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, static libraries and the CMake package of whirl.")

foreach(plugin ${plugins})
  string(TOUPPER ${plugin} P)
  set(CPACK_DEBIAN_${P}_PACKAGE_NAME whirl-${plugin})
  # a plug-in fits the program it was built with and no other
  set(CPACK_DEBIAN_${P}_PACKAGE_DEPENDS "whirl (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_${P}_DESCRIPTION "Plug-in ${plugin}: loaded by whirl when a deck asks for it.")
endforeach()
include(CPack)
