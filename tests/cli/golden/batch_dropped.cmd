mkdir in; cp "$SOURCE"/logs/opterra_synthetic_0[1-4].* in
flightwatt batch in --jobs 1 -o out > /dev/null 2> /dev/null || exit
rm in/opterra_synthetic_02.*
flightwatt batch in/opterra_synthetic_0[13].data --jobs 1 -o out > /dev/null || exit
cut -d, -f 1,3 out/flights.csv; ls out/flights; grep -c '^\[\[flights\]\]' out/model.toml
flightwatt batch in/opterra_synthetic_0[13].data --jobs 1 -o out > /dev/null
