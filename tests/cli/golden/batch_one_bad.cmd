mkdir in; cp "$SOURCE"/logs/opterra_synthetic_0[1-3].* in; echo 'rubbish' > in/opterra_synthetic_02.data
flightwatt batch in --jobs 1 -o out > shown.txt; code=$?
grep -c ',takeoff,' out/flights.csv; grep opterra_synthetic_02 out/flights.csv; ls out out/flights
exit $code
