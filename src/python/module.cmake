# The Python module: the package in dinal/ with the library _dinal beside it, complete in BUILD/python, so that
# PYTHONPATH=BUILD/python is all that python3 needs. What the sanitizers watch cannot be loaded into a plain python3.
if(DINAL_PYTHON STREQUAL "OFF" OR (DINAL_PYTHON STREQUAL "AUTO" AND DINAL_SANITIZE))
  return()
endif()
if(DINAL_PYTHON STREQUAL "AUTO")
  set(how QUIET)
else()
  set(how REQUIRED)
endif()
# Debian's, which has NumPy: another one may come first in the PATH.
find_program(Python_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_package(Python 3.10 COMPONENTS Interpreter Development.Module ${how})
if(Python_FOUND)
  find_package(pybind11 2.10 ${how})
endif()
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  message(STATUS "no Python module: pybind11-dev or python3-dev is missing")
  return()
endif()

file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
file(GLOB package CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/dinal/*.py)
set(python_folder ${CMAKE_BINARY_DIR}/python/dinal)
pybind11_add_module(dinal_python MODULE NO_EXTRAS ${sources})
target_link_libraries(dinal_python PRIVATE dinal_lua)
if(DINAL_UNITY)
  set_target_properties(dinal_python PROPERTIES UNITY_BUILD ON)
endif()
set_target_properties(dinal_python PROPERTIES OUTPUT_NAME _dinal LIBRARY_OUTPUT_DIRECTORY ${python_folder})
target_link_options(dinal_python PRIVATE -Wl,-z,relro,-z,now -Wl,--disable-new-dtags)
# The types for editors are written by the module itself.
add_custom_command(
  TARGET dinal_python
  POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${package} ${python_folder}
  COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${CMAKE_BINARY_DIR}/python PYTHONDONTWRITEBYTECODE=1 ${Python_EXECUTABLE} -m
          dinal.stubs ${python_folder}
  VERBATIM)
set_property(TARGET dinal_python APPEND PROPERTY LINK_DEPENDS ${package})
