// SPDX-License-Identifier: MIT
#pragma once

/// The extension of what a target of FuzzFile.cpp reads.
const char* fuzzExtension();
