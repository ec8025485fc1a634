# What `cmake --install` puts where. The components `program` and `python` are what scripts/package hands to others;
# `development` is the mathematics as a library for programs in C++: find_package(dinal), docs/install.md.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The program needs no file at run time: it runs from wherever it is put. Shared libraries that were put beside it
# (scripts/package does) come before those of the machine, for what they load in turn, too: hence the old kind of tag.
# The program in the build tree has the same entry: CMake would pad its own one with empty entries, and each of them is the
# current folder, where a stranger may have put a library.
set_target_properties(dinal PROPERTIES INSTALL_RPATH "$ORIGIN/../lib/dinal" BUILD_WITH_INSTALL_RPATH ON)
target_link_options(dinal PRIVATE -Wl,--disable-new-dtags)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS dinal)
install(FILES docs/dinal.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/dinal PATTERN cpp EXCLUDE)
install(FILES sheets/template.lua DESTINATION ${CMAKE_INSTALL_DATADIR}/dinal/sheets)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs FILES_MATCHING PATTERN "*.md" PATTERN "*.svg")

# The rooms of the mathematics. Where they are installed their headers are dinal/model/oscillator.hpp and so on, and say
# so to each other: names such as model/ and text/ are not for the include path of another project.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/dinal)
set(rooms text model motion theory analysis)
target_include_directories(dinal_core INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(dinal_core INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
target_compile_options(dinal_core INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
set_target_properties(dinal_core PROPERTIES EXPORT_NAME dinal)
foreach(room ${rooms})
  install(DIRECTORY src/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dinal FILES_MATCHING PATTERN "*.hpp")
endforeach()
list(JOIN rooms "|" any_room)
install(CODE "
  set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/dinal\")
  file(GLOB_RECURSE headers \"\${folder}/*.hpp\")
  foreach(header \${headers})
    file(READ \"\${header}\" text)
    string(REGEX REPLACE \"#include \\\"(${any_room})/\" \"#include \\\"dinal/\\\\1/\" changed \"\${text}\")
    if(NOT changed STREQUAL text)
      file(WRITE \"\${header}\" \"\${changed}\")
    endif()
  endforeach()")
install(TARGETS dinal_core EXPORT dinal)
install(DIRECTORY examples/cpp DESTINATION ${CMAKE_INSTALL_DATADIR}/dinal/examples)
install(EXPORT dinal NAMESPACE dinal:: FILE dinal-targets.cmake DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/dinal-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES scripts/dinal-config.cmake ${CMAKE_BINARY_DIR}/dinal-config-version.cmake DESTINATION ${package})
unset(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME)

# The Python module, for the python3 that it was built for; its libraries may be those of the program.
if(TARGET dinal_python)
  set(DINAL_PYTHON_FOLDER lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages
      CACHE STRING "where the Python module is installed, below the prefix")
  set_target_properties(dinal_python PROPERTIES INSTALL_RPATH "$ORIGIN/../../../dinal" BUILD_WITH_INSTALL_RPATH ON)
  install(TARGETS dinal_python DESTINATION ${DINAL_PYTHON_FOLDER}/dinal COMPONENT python)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/python/dinal DESTINATION ${DINAL_PYTHON_FOLDER} COMPONENT python
          FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
endif()
