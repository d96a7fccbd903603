fit="flightwatt fit --level-covariate wind_m_per_s -o windy.toml"
for i in 1 2 3 4 5 6; do fit="$fit $SOURCE/logs/opterra_synthetic_0$i.data"; done
$fit > table.txt && grep -c 'level_law = { covariate = "wind_m_per_s", flights = 6' windy.toml
mission() { printf 'mechanical = "windy.toml"\nconditions = { %s }\nbattery = { voltage_v = 11.1, resistance_ohm = 0.05, capacity_ah = 3 }\n' "$1" > mission.toml; flightwatt simulate mission.toml -o curve.csv; }
mission 'wind_m_per_s = 3' && tail -1 curve.csv
mission 'wind_m_per_s = 40'
mission 'height_m = 80'
