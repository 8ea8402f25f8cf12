// nlohmann::json complete, its functions compiled once (json.cpp): in each file that uses them they take a half second.
#pragma once
#include <nlohmann/json.hpp>

extern template class nlohmann::basic_json<>;
