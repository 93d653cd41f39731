# SPDX-License-Identifier: MIT
# `PROGRAM --out FOLDER` draws a picture of every pose, none of them blank.
file(REMOVE_RECURSE ${FOLDER})
execute_process(
  COMMAND ${WITH_DISPLAY} 1280x1024 ${PROGRAM} --out ${FOLDER}
  RESULT_VARIABLE status)
if(NOT status STREQUAL "0")
  message(FATAL_ERROR "exit status ${status}, expected 0")
endif()
file(GLOB pictures ${FOLDER}/bend*_twist*.png)
list(LENGTH pictures count)
if(NOT count EQUAL 9)
  message(FATAL_ERROR "${count} pictures in ${FOLDER}, expected 9")
endif()
foreach(picture IN LISTS pictures)
  file(SIZE ${picture} size)
  if(size LESS 20000) # a uniform picture of this size is smaller
    message(SEND_ERROR "${picture} has ${size} bytes: is it blank?")
  endif()
endforeach()
