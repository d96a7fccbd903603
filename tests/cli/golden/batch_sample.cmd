flightwatt batch "$SOURCE/logs" --jobs 1 --name sample -o out || exit
find out -type f | sort; head -n 1 out/flights.csv; cut -d, -f 1-3,7,11 out/flights.csv | tail -n +2
