// SPDX-License-Identifier: MIT
#pragma once

/// The extension of the files that a target of FuzzFile.cpp reads.
const char* fuzzExtension();
