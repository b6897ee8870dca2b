export {};
declare global {
  var polygonClipping: any;
}
