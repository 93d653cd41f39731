# SPDX-License-Identifier: MIT
# Bad usage exits with 2 and a reason.
foreach(arguments "--no-such-option" "--bend;nine" "--twist;1000" "--bend;nan" "--out"
        "-O;shapes=none" "--CullDrawThreadPerContext" "--window;0;0;0;0")
  execute_process(COMMAND ${PROGRAM} ${arguments}
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE message)
  if(NOT status STREQUAL "2" OR message STREQUAL "")
    message(SEND_ERROR "${arguments}: exit status ${status}, message \"${message}\"")
  endif()
endforeach()
