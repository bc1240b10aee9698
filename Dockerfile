# The program alone, without a system below it. `release/build program image` fills the folder that it is built from:
#
#   docker build -t jurist -f Dockerfile target/dist/image
#   docker run --rm -i jurist intervals - --param K < model.toml
#   docker run --rm -v "$PWD:/work" --user "$(id -u)" jurist map model.toml -x K -y T -o map.svg
FROM scratch
COPY . /
WORKDIR /work
USER 65534:65534
ENTRYPOINT ["/bin/jurist"]
