#pragma once
/// What most tests include, compiled once for all of them.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/monitors.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/problems.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <filesystem>
#include <fstream>
#include <functional>
