for arguments in '' '-o out' logs '--frobnicate logs -o out' 'logs -o a -o b' 'logs -o out --jobs=-1' 'logs -o out --jobs=99999' \
    'logs -o out --order=-1' 'logs -o out --order 99' 'logs -o out --weights best' 'logs -o'; do
  flightwatt batch $arguments; echo $?
done
ls
