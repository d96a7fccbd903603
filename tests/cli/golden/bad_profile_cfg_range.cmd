printf '[settings]\nfrequency = 10\n[components]\n[component.a]\nsrc = a\nrange = 1, 4\n' > spec.cfg
flightwatt profile spec.cfg -o out
