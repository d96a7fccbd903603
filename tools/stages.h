#pragma once

/// The stages, one a file. Each takes the arguments of `flightwatt-STAGE` and returns the exit code.
namespace flightwatt::stages {

int answer_stage(int argc, char** argv);
int batch_stage(int argc, char** argv);
int battery_stage(int argc, char** argv);
int check_stage(int argc, char** argv);
int compare_stage(int argc, char** argv);
int convert_stage(int argc, char** argv);
int diff_stage(int argc, char** argv);
int export_stage(int argc, char** argv);
int fit_stage(int argc, char** argv);
int init_stage(int argc, char** argv);
int merge_stage(int argc, char** argv);
int new_mission_stage(int argc, char** argv);
int parse_stage(int argc, char** argv);
int path_stage(int argc, char** argv);
int plan_stage(int argc, char** argv);
int play_stage(int argc, char** argv);
int predict_stage(int argc, char** argv);
int profile_stage(int argc, char** argv);
int replay_stage(int argc, char** argv);
int report_stage(int argc, char** argv);
int segment_stage(int argc, char** argv);
int simulate_stage(int argc, char** argv);
int synthesize_stage(int argc, char** argv);
int trends_stage(int argc, char** argv);
int validate_stage(int argc, char** argv);
int watch_stage(int argc, char** argv);

}  // namespace flightwatt::stages
