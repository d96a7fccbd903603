fit="flightwatt fit --level-covariate wind_m_per_s -o windy.toml"
for i in 2 3 4 5 6; do fit="$fit $SOURCE/logs/opterra_synthetic_0$i.data"; done
$fit > table.txt && flightwatt predict --model windy.toml --until 200 --remaining 400 "$SOURCE/logs/opterra_synthetic_01.data"
