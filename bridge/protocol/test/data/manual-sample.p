;; Parameters for the Pioneer robot
;;
;; counts/rev = 6300 (5-inch wheels)
;;
AngleConvFactor 0.0009973     ; radians per encoder count diff (2PI/6300)
DistConvFactor  0.079         ; $13F4 ticks per 5*PI (inches) distance
VelConvFactor   2.0           ; mm/sec per encoder count per 1/50 sec
RobotRadius     220.0         ; radius in mm
RobotDiagonal   90.0          ; half-height to diagonal of octagon
;; These are for seven sonars: five front, two sides
;;
;; Sonar parameters
;;              SonarNum N is number of sonars
;;              SonarUnit I X Y TH is unit I (0 to N-1) description
;;              X, Y are position of sonar in mm, TH is bearing in degrees
;;
;;
RangeConvFactor 0.229         ; sonar range mm per 1 usec tick
;;
SonarNum 7
;;        # x   y   th
;;-------------------------
SonarUnit 0 120 80 90
SonarUnit 1 100 100 20
SonarUnit 2 130 40 10
SonarUnit 3 130 0 0
SonarUnit 4 130 -40 -10
SonarUnit 5 100 -100 -20
SonarUnit 6 120 -80 -90
SonarUnit 7 0 0 0
