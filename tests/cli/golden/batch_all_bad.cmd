mkdir in; echo 'rubbish' > in/a.data; : > in/b.data
mkdir out; touch out/model.toml out/table1.txt
flightwatt batch in --jobs 1 -o out; code=$?
ls out out/flights
exit $code
