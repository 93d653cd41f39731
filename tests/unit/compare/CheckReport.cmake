# SPDX-License-Identifier: MIT
# `PROGRAM --report` exits with 0, and its table meets theory and our own limit.
execute_process(COMMAND ${PROGRAM} --report RESULT_VARIABLE status OUTPUT_VARIABLE report)
if(NOT status STREQUAL "0")
  message(FATAL_ERROR "exit status ${status}, expected 0")
endif()
message("${report}")

# expect_row(BEND TWIST METHOD FIGURES): expects a row of the table with this start; FIGURES is a
# pattern.
function(expect_row bend twist method figures)
  string(REGEX MATCH "\n +${bend} +${twist}  ${method} +${figures}" row "${report}")
  if(row STREQUAL "")
    message(SEND_ERROR "bend ${bend}, twist ${twist}, ${method}: expected ${figures}")
  endif()
endfunction()

set(any "[0-9.]+")
set(whole "(0\\.99[0-9]|1\\.00[0-9])")
# Volume, least area, area at the joint. Linear blending: cos^2 of half a twist, cos of half a bend.
expect_row(0 90 "linear blending" "${any} +0\\.500 +0\\.500 ")
expect_row(0 180 "linear blending" "0\\.871 +0\\.000 +0\\.000 ")
expect_row(90 0 "linear blending" "${any} +0\\.707 +0\\.707 ")
expect_row(150 0 "linear blending" "${any} +0\\.259 +0\\.259 ")
expect_row(0 180 "dual quaternions" "${whole} +${whole} +${whole} ")
foreach(pose "0;90" "0;180" "0;270" "0;330" "60;0" "90;0" "120;0")
  list(GET pose 0 bend)
  list(GET pose 1 twist)
  expect_row(${bend} ${twist} "osgSkin" "${whole} +${whole} +${whole} ")
endforeach()

if(NOT report MATCHES "closed form\n[^\n]*at most [0-9.]+e-1[3-9]\\.")
  message(SEND_ERROR "expected linear blending to meet its closed form to 1e-12")
endif()
