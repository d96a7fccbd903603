mkdir in; cp "$SOURCE"/logs/opterra_synthetic_01.* in; ln -s nowhere.data in/gone.data; ln -s loop.data in/loop.data
flightwatt batch in --jobs 1 -o out > shown.txt; code=$?; cut -d, -f 1-3 out/flights.csv; exit $code
