// Cases and results as lines of JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/batch.h"
#include "app/src/case_evaluator.h"
#include "app/src/file_hash.h"
#include "app/src/one_line.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& what, const std::string& reason) {
  throw Error("", what, reason, "one line as this version writes it is needed");
}

/// Not-a-number is null in JSON both ways.
json numbers_json(const double* begin, std::size_t count) {
  json numbers = json::array();
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(std::isfinite(begin[i]) ? json(begin[i]) : json(nullptr));
  return numbers;
}

void append_numbers(const json& numbers, std::size_t count, std::vector<double>& values) {
  if (numbers.size() != count)
    refuse("result",
           "has " + std::to_string(numbers.size()) + " numbers in place of " + std::to_string(count));
  for (const json& number : numbers) values.push_back(number.is_null() ? kNoValue : number.get<double>());
}

/// What SQLite and JSON can hold and give back.
void make_storable(std::vector<double>& values) {
  for (double& value : values) value = std::isfinite(value) ? value + 0.0 : kNoValue;
}

}  // namespace

std::string to_json(const BatchCase& batch_case) {
  return json{
      {"key", batch_case.key}, {"inputs", json::parse(batch_case.inputs)}, {"source", batch_case.source}}
      .dump();
}

BatchCase case_from_json(std::string_view line) try {
  const json parsed = json::parse(line);
  BatchCase result{parsed.at("key").get<std::string>(), parsed.at("inputs").dump(),
                   parsed.at("source").get<std::string>()};
  if (result.key != sha256(result.inputs)) refuse("case", "its key is not that of its inputs");
  return result;
} catch (const nlohmann::json::exception& failure) {
  refuse("case", std::string("is not readable: ") + failure.what());
}

std::string to_json(const BatchResult& result) {
  const std::size_t width = batch_columns().points.size();
  json points = json::array();
  for (std::size_t i = 0; i + width <= result.points.size(); i += width)
    points.push_back(numbers_json(result.points.data() + i, width));
  return json{{"key", result.key},
              {"error", result.error.empty() ? json(nullptr) : json(result.error)},
              {"summary", numbers_json(result.summary.data(), result.summary.size())},
              {"points", std::move(points)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

BatchResult result_from_json(std::string_view line) try {
  const json parsed = json::parse(line);
  BatchResult result;
  result.key = parsed.at("key").get<std::string>();
  if (!parsed.at("error").is_null()) result.error = parsed.at("error").get<std::string>();
  const BatchColumns& columns = batch_columns();
  append_numbers(parsed.at("summary"), result.error.empty() ? columns.summary.size() : 0, result.summary);
  for (const json& row : parsed.at("points")) append_numbers(row, columns.points.size(), result.points);
  return result;
} catch (const nlohmann::json::exception& failure) {
  refuse("result", std::string("is not readable: ") + failure.what());
}

BatchResult failed_result(const BatchCase& batch_case) {
  BatchResult result;
  result.key = batch_case.key;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Error& error) {
    // Without the file: where it lies says nothing about the case, and differs between machines.
    result.error = Error("", error.entity(), error.reason(), error.hint()).what();
  } catch (const std::exception& failure) {
    result.error = std::string("unexpected failure: ") + failure.what();
  }
  result.error = one_line(result.error);
  if (result.error.empty()) result.error = "unexpected failure";
  return result;
}

BatchResult evaluate_on(const CaseSubject& subject, const BatchCase& batch_case) {
  try {
    BatchResult result = subject.evaluate(batch_case);
    result.key = batch_case.key;
    make_storable(result.summary);
    make_storable(result.points);
    return result;
  } catch (const std::exception&) {
    return failed_result(batch_case);
  }
}

}  // namespace catoptra::app
