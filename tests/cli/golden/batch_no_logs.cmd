mkdir in
flightwatt batch in -o out; echo $?
flightwatt batch nowhere -o out; echo $?
flightwatt batch '' -o out; echo $?
ls
