// web/build.mjs bundles the file behind "worker:" into one script and gives its text.
declare module "worker:*" {
  const text: string;
  export default text;
}
