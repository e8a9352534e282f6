// Takes depth frames into Bonxai's probabilistic map, one at a time as benches/peers/bonxai.py asks for them.
//
// bonxai FRAMES CELL RANGE: FRAMES is a file that `treadwell.timing.frames.write_frames` makes, CELL and RANGE are metres. Each
// line of the standard input is "new", for an empty map, or the number of a frame; the answer to a frame is the processor's
// time that the map took for it, ms.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bonxai_map/probabilistic_map.hpp"

namespace {

struct Frame {
  Eigen::Vector3d eye;
  std::vector<Eigen::Vector3d> points;
};

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec);
}

template <typename Value>
std::vector<Value> read(std::FILE* file, std::size_t count) {
  std::vector<Value> values(count);
  if (std::fread(values.data(), sizeof(Value), count, file) != count) {
    std::fprintf(stderr, "the file of frames ends too early\n");
    std::exit(1);
  }
  return values;
}

std::vector<Frame> frames_of(const char* path) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) {
    std::perror(path);
    std::exit(1);
  }
  read<char>(file, 4);
  const auto size = read<std::int32_t>(file, 3);
  const auto camera = read<float>(file, 4);
  std::vector<Frame> frames;
  for (int index = 0; index < size[2]; ++index) {
    const auto turn = read<float>(file, 9);
    const auto eye = read<float>(file, 3);
    const auto depths = read<float>(file, std::size_t(size[0]) * std::size_t(size[1]));
    Frame frame{{eye[0], eye[1], eye[2]}, {}};
    for (int pixel = 0; pixel < size[0] * size[1]; ++pixel) {
      const double depth = depths[pixel];
      if (!(depth > 0.0)) {
        continue;
      }
      const double x = depth * (pixel % size[0] - camera[2]) / camera[0];
      const double y = depth * (pixel / size[0] - camera[3]) / camera[1];
      Eigen::Vector3d point = frame.eye;
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] += turn[3 * axis] * x + turn[3 * axis + 1] * y + turn[3 * axis + 2] * depth;
      }
      frame.points.push_back(point);
    }
    frames.push_back(std::move(frame));
  }
  std::fclose(file);
  return frames;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "bonxai FRAMES CELL RANGE\n");
    return 1;
  }
  const auto frames = frames_of(arguments[1]);
  const double cell = std::atof(arguments[2]);
  const double range = std::atof(arguments[3]);
  auto map = std::make_unique<Bonxai::ProbabilisticMap>(cell);
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "new") {
      map = std::make_unique<Bonxai::ProbabilisticMap>(cell);
      continue;
    }
    const auto& frame = frames.at(std::stoul(line));
    const double started = processor_ms();
    map->insertPointCloud(frame.points, frame.eye, range);
    std::printf("%.6f\n", processor_ms() - started);
    std::fflush(stdout);
  }
}
